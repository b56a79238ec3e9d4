#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// A blind trial: a mill with something hidden in it, and the data that its instruments bring.
namespace tumble::trials {

enum class Kind { kSingle, kHard, kNone, kArtefact, kPhysics, kPair, kUnknown, kTurnLocked };
enum class Tier { kTracks, kFilms, kScalars };  // what the data are

const char* name_of(Kind kind);  // "turn_locked"
const char* name_of(Tier tier);
Kind kind_named(const std::string& name);  // throw InputError, naming what there is
Tier tier_named(const std::string& name);

enum class Nature { kPhysics, kArtefact, kUnknown };
const char* name_of(Nature nature);
Nature nature_named(const std::string& name);

struct Hidden {
  std::string name;  // "rolling_resistance", "camera_scale", "magnus_lift"
  Nature nature = Nature::kPhysics;
  double strength = 1;            // of full
  std::string parameter;          // as verdict.json is to name it
  double value = 0;               // the parameter's true value
  std::vector<std::string> sets;  // what MILL.toml could say of it: "effects.cohesion.force=0.4"
};

// What is sealed.
struct TrialKey {
  std::string name;  // "0001", of the trial's folder
  std::string salt;
  Kind kind = Kind::kNone;
  Tier tier = Tier::kTracks;
  std::vector<Hidden> hidden;
  std::vector<std::pair<std::string, double>> uncertain;  // keys of MILL.toml and their true values
  std::uint64_t seed = 0;                                 // of packings and instruments
};

}  // namespace tumble::trials
