#include "trials/unknown_effects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/mill_shape.h"
#include "core/units.h"
#include "sim/laws/linear_spring_dashpot.h"

namespace tumble::trials {
namespace {

using sim::BallState;
using sim::OutsideForce;
using sim::OutsidePush;

constexpr double kReach = 2;         // of the shell's magnet, in mean ball radii
constexpr double kSector = kPi / 3;  // of the shell that is magnetic
constexpr double kJetFrom = 0.1;     // height above the axis from which the jet blows [R]
constexpr double kGrowth = 0.5;      // what takes room grows to its size, not to blow up a charge at rest there [s]
constexpr double kSlipSpeed = 0.02;  // below it, friction against the glass fades [m/s]
constexpr int kPackedPockets = 2;    // side by side
constexpr double kBareLifter = 0.022 / 0.275;  // of a mill without lifters: what packs is as deep as this [R]

constexpr std::array kEffects{
    UnknownEffect{"magnus_lift", "F = pi rho r^3 omega x v",
                  "a fluid's lift on a ball that spins: Rubinow & Keller, J. Fluid Mech. 11 (1961) 447", "density",
                  "kg/m3", 1500},
    UnknownEffect{"shell_magnet", "F = pull m g exp(-gap / (2 r_mean)) towards the shell",
                  "a shell that is magnetised, as by welding", "pull", "m g", 0.8},
    UnknownEffect{"magnetic_sector", "shell_magnet on 60 degrees of the shell, which turn with it",
                  "one liner plate that is magnetised", "pull", "m g", 3},
    UnknownEffect{"packed_pockets",
                  "smooth wall of fill x lifter height in two neighbouring pockets, as stiff as the shell's",
                  "ore packed between lifters", "fill", "lifter height", 0.9},
    UnknownEffect{"swirling_fluid", "F = -6 pi eta r (v - W x R); M = -8 pi eta r^3 (omega - W)",
                  "a fluid that turns with the mill (Stokes 1851), where fluid_drag's is at rest", "viscosity", "Pa s",
                  0.15},
    UnknownEffect{"water_jet", "F = push m g to the right where y > 0.1 R", "a feed spray that blows across the mill",
                  "push", "m g", 0.2},
    UnknownEffect{"centre_tube", "smooth round tube of radius a about the axis, as stiff as the shell",
                  "a scoop or feed tube through the mill", "radius", "R", 0.4},
    UnknownEffect{"standing_glass", "F = -mu m g v / |v|",
                  "balls that rub on a front glass which does not turn (Coulomb), where end_wall_friction's ends do",
                  "coefficient", "", 0.12},
};

// A smooth elastic wall met at `depth` > 0 with the speed `closing`; it never pulls.
struct SmoothWall {
  double stiffness, damping_ratio;
  explicit SmoothWall(const Config& mill)
      : stiffness(wall_contact(mill).normal_stiffness),
        damping_ratio(sim::damping_ratio(wall_contact(mill).restitution)) {}
  double push(double depth, double closing, double mass) const {
    if (depth <= 0) return 0;
    return std::max(0.0, stiffness * depth + 2 * damping_ratio * std::sqrt(stiffness * mass) * closing);
  }
};

double grown(const BallState& b) { return std::min(1.0, b.time / kGrowth); }

OutsidePush along_radius(const BallState& b, double outwards) {
  const double distance = std::hypot(b.x, b.y);
  if (distance == 0) return {};
  OutsidePush p;
  p.fx = outwards * b.x / distance;
  p.fy = outwards * b.y / distance;
  p.reacts_on_mill = true;
  return p;
}
double outward_speed(const BallState& b) { return (b.x * b.vx + b.y * b.vy) / std::hypot(b.x, b.y); }

// Where on the turning shell the ball is, counter-clockwise from lifter 0, [0, 2 pi).
double place_on_shell(const BallState& b) {
  const double turn = std::fmod(std::atan2(b.y, b.x) - b.mill_angle, 2 * kPi);
  return turn < 0 ? turn + 2 * kPi : turn;
}

double mean_radius(const Config& mill) {
  const std::vector<int> counts = class_counts(mill);
  double sum = 0, number = 0;
  for (std::size_t c = 0; c < counts.size(); ++c) {
    sum += counts[c] * mill.charge.balls[c].radius;
    number += counts[c];
  }
  return sum / number;
}

OutsideForce magnet(double pull, const Config& mill, double sector) {
  const double shell = mill.mill.diameter / 2, reach = kReach * mean_radius(mill);
  return [=](const BallState& b) {
    if (sector < 2 * kPi && place_on_shell(b) > sector) return OutsidePush{};
    const double gap = std::max(0.0, shell - std::hypot(b.x, b.y) - b.radius);
    return along_radius(b, pull * b.mass * kGravity * std::exp(-gap / reach));
  };
}

OutsideForce packed_pockets(double fill, const Config& mill) {
  const MillShape shape = make_mill_shape(mill);
  const bool bare = shape.tip_radius >= shape.radius;
  const int lifters = bare ? 12 : shape.lifter_count;
  const double depth = fill * (bare ? kBareLifter * shape.radius : shape.radius - shape.tip_radius);
  const double shell = shape.radius, sector = kPackedPockets * 2 * kPi / lifters;
  const SmoothWall wall(mill);
  return [=](const BallState& b) {
    const double into = std::hypot(b.x, b.y) + b.radius - (shell - depth * grown(b));
    if (into <= 0 || place_on_shell(b) > sector) return OutsidePush{};
    return along_radius(b, -wall.push(into, outward_speed(b), b.mass));
  };
}

OutsideForce centre_tube(double share, const Config& mill) {
  const double radius = share * mill.mill.diameter / 2;
  const SmoothWall wall(mill);
  return [=](const BallState& b) {
    const double into = radius * grown(b) + b.radius - std::hypot(b.x, b.y);
    if (into <= 0) return OutsidePush{};
    return along_radius(b, wall.push(into, -outward_speed(b), b.mass));
  };
}

}  // namespace

std::span<const UnknownEffect> unknown_effects() { return kEffects; }

OutsideForce force_of(const std::string& name, double value, const Config& mill) {
  if (name == "magnus_lift")
    return [value](const BallState& b) {
      const double lift = kPi * value * b.radius * b.radius * b.radius * b.spin;
      return OutsidePush{-lift * b.vy, lift * b.vx};
    };
  if (name == "shell_magnet") return magnet(value, mill, 2 * kPi);
  if (name == "magnetic_sector") return magnet(value, mill, kSector);
  if (name == "packed_pockets") return packed_pockets(value, mill);
  if (name == "swirling_fluid")
    return [value](const BallState& b) {
      const double drag = 6 * kPi * value * b.radius, turn = b.mill_speed;
      return OutsidePush{-drag * (b.vx + turn * b.y), -drag * (b.vy - turn * b.x),
                         -8 * kPi * value * b.radius * b.radius * b.radius * (b.spin - turn), true};
    };
  if (name == "water_jet") {
    const double from = kJetFrom * mill.mill.diameter / 2;
    return [=](const BallState& b) { return OutsidePush{b.y > from ? value * b.mass * kGravity : 0, 0}; };
  }
  if (name == "centre_tube") return centre_tube(value, mill);
  if (name == "standing_glass")
    return [value](const BallState& b) {
      const double per_speed = -value * b.mass * kGravity / std::max(kSlipSpeed, std::hypot(b.vx, b.vy));
      return OutsidePush{per_speed * b.vx, per_speed * b.vy};
    };
  throw std::logic_error("no unknown effect " + name);
}

}  // namespace tumble::trials
