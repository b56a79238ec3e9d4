#pragma once
#include <string>
#include <vector>

#include "core/config.h"
#include "diagnose/observation.h"

// Everything that may be behind a disagreement: the effects of core/effects.h, and the ways in which a measurement
// errs. Strengths are in units of each suspect's full strength.
namespace tumble::diagnose {

enum class SuspectKind { kPhysics, kArtefact };

struct Suspect {
  std::string name;     // "rolling_resistance", "camera_scale"
  std::string variant;  // "one lifter", where a name has several ways to be guilty
  SuspectKind kind = SuspectKind::kPhysics;
  double low = 0, high = 1.5;  // strengths that are looked at

  // Simulated: the keys of MILL.toml that stand for strength 1, and what they are for none: key = none + s (full -
  // none).
  struct Set {
    std::string key;
    double none, full;
    bool whole = false;  // rounded to a whole number
  };
  std::vector<Set> sets;
  std::vector<std::string> fixed;  // assignments that go with any strength
  // It is somewhere on the drum, and looked for at every lifter: simulated at lifter 0.
  bool turns_with_drum = false;
  bool acts_in_contacts = false;
  // Or seen: how the observer errs at strength 1, or the torque's offset, one and the same in all
  // experiments [share of the mean torque of those that are fitted].
  Observer observer;
  double torque_offset = 0;
  // What strength 1 is, for the report: of this parameter, in this unit.
  std::string parameter, unit;
  double full = 1;

  bool is_simulated() const { return !sets.empty() || !fixed.empty(); }
};

// Those that this mill can have: effects that it has already are no suspects.
std::vector<Suspect> suspects_of(const Config& mill);

// "effects.rolling_resistance.coefficient=0.01" for half its strength.
std::vector<std::string> sets_at(const Suspect& suspect, double strength);
// The strength that those come to, where a key takes whole numbers only.
double strength_of_sets(const Suspect& suspect, double strength);

}  // namespace tumble::diagnose
