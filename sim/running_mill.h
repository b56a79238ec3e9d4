#pragma once
#include <cstdint>
#include <string>

#include "sim/charge.h"
#include "sim/contact_list.h"
#include "sim/ledger.h"
#include "sim/mill_model.h"

namespace tumble::sim {

// Flights: which balls touch nothing, and how high they have come.
struct Flights {
  std::vector<int> contacts;  // that the ball has
  std::vector<double> apex;   // highest since it last left a contact [m]
};

// A running mill. Everything that the future depends on: copied, it runs on in the same way.
struct RunningMill {
  MillModel model;
  Charge charge;
  ContactList ball_contacts, wall_contacts;
  Flights flights;
  Ledger ledger;
  std::int64_t step = 0;  // since the mill began to turn

  // Bookkeeping of the near lists; changes no result.
  double skin = 0;     // [m]
  double moved = 0;    // what the fastest ball or the shell may have moved since the lists were renewed [m]
  double fastest = 0;  // speed of the fastest ball [m/s]
  bool stale = true;   // the lists must be renewed before use
  ContactSearch search;
  std::vector<std::uint32_t> close;  // contacts to look at in this step
};

// Balls as they lie at step 0, with their velocities at that moment (taken from `vx`, `vy`, `spin`).
RunningMill start_mill(const MillModel& model, Charge charge);

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
