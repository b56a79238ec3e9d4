#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/progress.h"
#include "diagnose/observation.h"
#include "diagnose/suspects.h"

// What a mill looks like under every suspect: many short simulations with the uncertain keys drawn at random, each with
// one suspect at a random strength or none, and what an observer who errs makes of them.
namespace tumble::diagnose {

inline constexpr std::array kSpans{0.004, 0.008, 0.016, 0.032};  // before and after a frame, of velocities [s]

// The observers who err, at their full strengths both ways: in pairs, the order of the artefacts in suspects_of.
inline constexpr double kObserved = 1;  // strength
inline constexpr std::size_t kObservers = 6;
std::array<Observer, kObservers> observers();

struct Sight {  // of one run by one observer
  std::array<Observation, kSpans.size()> by_span;
};

struct SignatureRun {
  std::string error;  // why it failed; then the rest is empty
  std::size_t condition = 0;
  std::vector<double> uncertain;  // each key's distance from MILL.toml's value, in its standard deviations
  int suspect = -1;               // of the condition's suspects; -1: none
  double strength = 0;
  std::uint64_t seed = 0;
  double revolutions = 0;  // that were looked at
  Sight seen;
  std::array<Sight, kObservers> misseen;
};

// One run, looked at while it goes on; by all observers, or by the one who does not err (a fifth less time).
enum class Watched { kAll, kRight };
// `condition`: the mill as it was said to be, by which laws of single balls are read.
SignatureRun run_signature(const Config& config, const Config& condition, const Progress& progress = {},
                           Watched watched = Watched::kAll);

struct SignatureAsked {
  std::vector<double> uncertain;
  int suspect = -1;
  double strength = 0;
  std::uint64_t seed = 0;
};
// What is to be simulated of a condition, block after block: each is a small library of its own, with twelve runs
// without any suspect and five of each suspect that is simulated, ten of those that act in contacts, which are hard to
// tell apart; five blocks are a good one. Deterministic.
std::vector<SignatureAsked> plan_block(std::size_t block, std::size_t uncertain, const std::vector<Suspect>& suspects);
inline constexpr std::size_t kGoodBlocks = 5;

// For files: all numbers of a run in a row; empty for one that failed. Without the plan's own: condition, uncertain,
// suspect, seed. `unpack` returns false for a row that is of no such run.
std::vector<float> pack(const SignatureRun& run);
bool unpack(const std::vector<float>& row, const ObservationLayout& layout, SignatureRun& run);

// A condition's mill without what does not matter to its library: seed, frame rate, length of the run.
Config bare(Config condition);

}  // namespace tumble::diagnose
