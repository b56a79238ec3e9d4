#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel_for.h"
#include "sim/cell_grid.h"
#include "sim/charge.h"
#include "sim/ledger.h"
#include "sim/mill_model.h"
#include "sim/outside_force.h"
#include "sim/share.h"

namespace tumble::sim {

// Steps of the sums over a mill's contacts and balls.
ExactSums exact_sums(const MillModel& model, const Charge& charge);

// Flights: which balls touch nothing, and how high they have come.
struct Flights {
  std::vector<int> contacts;  // that the ball has
  std::vector<double> apex;   // of a ball that has none: highest since it left the last one [m]
};

// A running mill. Everything that the future depends on: copied, it runs on in the same way.
struct RunningMill {
  MillModel model;
  std::array<Damping, 2> damping;  // of a ball on a ball, on the wall
  ExactSums exact;
  Charge charge;
  Flights flights;
  Ledger ledger;
  std::int64_t step = 0;  // since the mill began to turn
  OutsideForce outside;   // empty: none

  std::vector<Patch> patches;
  std::vector<Share> shares;  // one for each thread

  // Bookkeeping of the near pairs; changes no result.
  double mean_radius = 0, smallest_radius = 0;  // [m]
  double skin = 0;                              // [m]
  double moved = 0;    // what the fastest ball or the shell may have moved since the near pairs were found [m]
  double fastest = 0;  // speed of the fastest ball [m/s]
  bool stale = true;   // near pairs must be searched for before use
  CellGrid grid;
  int searches = 0, searches_per_sort = 0;  // balls are sorted by cell with every so many searches; 0: never
  std::vector<Ended> ended_at_wall;
  const Kernels* kernels = nullptr;
  ConvexLifters lifters;                       // as the kernels see them at this step, if they are such
  LifterRuns runs;                             // and whatever they are
  std::vector<double> lifter_cos, lifter_sin;  // of each feature
};

// Threads that are worth their while in one run of so many balls, out of those that the program may use.
int threads_for(std::size_t balls);

// Of the shell's circle at its fastest [m/s].
double shell_speed(const MillModel& model);

// body(share), each in its thread.
template <class Body>
void for_shares(RunningMill& mill, const Body& body) {
  if (mill.shares.size() == 1) return body(mill.shares[0]);
  parallel_for(mill.shares.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) body(mill.shares[s]);
  });
}

inline Patch& patch_at(RunningMill& mill, int p) { return mill.patches[static_cast<std::size_t>(p)]; }

// body(patch, share), each in its share's thread.
template <class Body>
void for_patches(RunningMill& mill, const Body& body) {
  for_shares(mill, [&](Share& share) {
    for (int p = share.first; p < share.last; ++p) body(patch_at(mill, p), share);
  });
}

// The balls as the kernels see them.
ChargeView view_of(RunningMill& mill);

// Balls as they lie at step 0, with their velocities at that moment (taken from `vx`, `vy`, `spin`). `threads` share
// the work of a step, in patches of so many balls.
inline constexpr int kBallsPerPatch = 2048;
RunningMill start_mill(const MillModel& model, Charge charge, int threads = 1, int balls_per_patch = kBallsPerPatch);

// visit(contact) for those of one kind, in no order; i and j are the balls' numbers.
template <class Visit>
void for_contacts(const RunningMill& mill, Kind kind, const Visit& visit) {
  const std::vector<int>& id = mill.charge.id;
  for (const Patch& patch : mill.patches) {
    const ContactTable& table = patch.touching[static_cast<std::size_t>(kind)];
    for (int k = 0; k < table.size(); ++k) {
      Contact c = contact_at(table, k);
      c.i = id[static_cast<std::size_t>(c.i)];
      if (kind == Kind::kBalls) c.j = id[static_cast<std::size_t>(c.j)];
      if (kind == Kind::kBalls && c.i > c.j) std::swap(c.i, c.j);
      visit(c);
    }
  }
}
std::vector<Contact> contacts_of(const RunningMill& mill, Kind kind);

// One time step: drift, contact forces, kick. Throws WorkError when the run leaves physics.
void advance(RunningMill& mill);

// The end of every run that leaves physics: throws WorkError with step, time and what to do.
[[noreturn]] void left_physics(const RunningMill& mill, const std::string& what);

// Torque and closure need no more than the ledger; these are the energies at the positions' own time [J].
struct Energies {
  double kinetic = 0, potential = 0, elastic = 0;
};
Energies energies_of(const RunningMill& mill);

}  // namespace tumble::sim
