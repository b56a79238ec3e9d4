#include "trials/trial.h"

#include <array>

#include "core/error.h"

namespace tumble::trials {
namespace {

constexpr std::array kKindNames{"single", "hard", "none", "artefact", "physics", "pair", "unknown", "turn_locked"};
constexpr std::array kTierNames{"tracks", "films", "scalars"};
constexpr std::array kNatureNames{"physics", "artefact", "unknown"};

template <class Value, class Names>
Value named(const Names& names, const std::string& name, const char* what) {
  std::string known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (name == names[i]) return static_cast<Value>(i);
    known += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  throw InputError(what, "is \"" + name + "\"; give one of " + known);
}

}  // namespace

const char* name_of(Kind kind) { return kKindNames[static_cast<std::size_t>(kind)]; }
const char* name_of(Tier tier) { return kTierNames[static_cast<std::size_t>(tier)]; }
const char* name_of(Nature nature) { return kNatureNames[static_cast<std::size_t>(nature)]; }
Kind kind_named(const std::string& name) { return named<Kind>(kKindNames, name, "--kind"); }
Tier tier_named(const std::string& name) { return named<Tier>(kTierNames, name, "--data"); }
Nature nature_named(const std::string& name) { return named<Nature>(kNatureNames, name, "nature"); }

}  // namespace tumble::trials
