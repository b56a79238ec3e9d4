#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/statistics.h"

// Stiffness of a contact from balls that were dropped on a load cell (Mishra & Rajamani 1992, p. 601, Tables 1 and 2).
//
// A row gives the greatest force F and displacement d of one impact. Until the ball stands still, at d, the force has
// taken up all that it brought along, E = m g (h + d), whatever is lost in it. A linear spring makes three numbers of
// that, k = F / d, 2 E / d^2 and F^2 / (2 E), which are one if the contact is linear: the first is the geometric mean
// of the others. F / d is what is used, being the slope that the paper asks for; by how much the others differ from it
// says how far a linear spring is from the contact, and is part of the standard error.
//
// Of a law F ~ d^n it takes two ways to know n. From the height: F ~ E^(n/(n+1)) and d ~ E^(1/(n+1)), so n is the
// quotient of the two slopes against ln E, the heights being exact (E is the instrument, which errors in d do not
// bias). And from each impact alone, by energy: E = F d / (n + 1).
namespace tumble::diagnose {

struct LoadCellDrop {
  double ball_mass = 0;                // m [kg], > 0
  double fall_height = 0;              // h [m], > 0
  double max_force = 0;                // F [N], > 0
  double max_displacement = 0;         // d [m], > 0
  int particle_layers = 0;             // between ball and anvil; 0 = bare metal
  std::string particle_size;           // as given; empty for bare metal
  double given_stiffness = kNotGiven;  // the source's own [N/m]; only compared
};

// The three numbers of one drop [N/m].
struct DropStiffness {
  double by_slope = 0;   // F / d
  double by_energy = 0;  // 2 E / d^2
  double by_force = 0;   // F^2 / (2 E)
};
DropStiffness stiffness_of(const LoadCellDrop& drop);

enum class FavouredLaw { kLinear, kHertz, kNeither, kCannotTell };

// Drops with the same particles between ball and anvil.
struct StiffnessGroup {
  int particle_layers = 0;
  std::string particle_size;
  std::vector<LoadCellDrop> drops;

  Estimate stiffness;            // geometric mean of F / d [N/m]; se: scatter of the drops, and half_spread
  double by_energy = kNotGiven;  // geometric means of the others [N/m]
  double by_force = kNotGiven;
  double half_spread = kNotGiven;  // |ln(2 E / F d)|, mean over the drops: by_energy = stiffness e^(+-half_spread)

  Estimate exponent_by_height;  // n, over the heights at equal mass; NaN with fewer than three heights
  int freedom_by_height = 0;    // its degrees of freedom
  Estimate exponent_by_energy;  // n, mean of F d / E - 1; se NaN for a single drop

  FavouredLaw law = FavouredLaw::kCannotTell;  // n = 1 or n = 1.5, by ten to one at least of both ways together
  std::string reason;

  // For contact.law = "hertz": contact.normal_stiffness [N/m], of two of the heaviest balls dropped that meet at
  // effects.hertz_contact.reference_speed (1 m/s). With F = K d^1.5, K from E = (2/5) K d^2.5.
  double hertz_normal_stiffness = kNotGiven;
};

// In the order of layers, then of first appearance.
std::vector<StiffnessGroup> stiffness_groups(std::span<const LoadCellDrop> drops);

// Tangential over normal stiffness, as the paper takes it (p. 601: 2/3 to 1 by the theory of Hertzian contacts).
inline constexpr double kTangentialShare = 2.0 / 3.0;

}  // namespace tumble::diagnose
