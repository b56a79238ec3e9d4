#include "trials/draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "diagnose/suspects.h"
#include "io/config_file.h"
#include "io/config_keys.h"
#include "trials/unknown_effects.h"

namespace tumble::trials {
namespace {

using diagnose::Suspect;
using diagnose::SuspectKind;

constexpr double kWeakest = 0.35, kStrongest = 1.1;  // of full strength
constexpr double kFarthest = 2;                      // standard deviations of what is uncertain
constexpr std::array kHard{"hertz_contact", "wall_friction", "friction_weakening"};
constexpr std::array kUnseenInScalars{"camera_scale", "frame_clock"};  // neither changes an angle or a torque
constexpr double kLeastWorn = 0.6;          // of full strength: a single lifter that is worn by less hardly shows
constexpr std::uint64_t kMostRipples = 12;  // a revolution

// What may hide in a trial of one kind: each recipe draws its strengths and places.
using Recipe = std::function<std::vector<Hidden>(Random&)>;

double strength_of(const Suspect& s, Random& random) {
  const double size = random.uniform(kWeakest, kStrongest);
  const bool down = s.low < 0 && random.below(2) == 1;
  return std::clamp(down ? -size : size, s.low, s.high);
}

Hidden hide(const Suspect& s, Random& random) {
  Hidden h{s.name, s.kind == SuspectKind::kPhysics ? Nature::kPhysics : Nature::kArtefact, 0, s.parameter, 0, {}};
  const double strength = strength_of(s, random);
  h.strength = diagnose::strength_of_sets(s, strength);
  if (h.strength == 0) h.strength = std::copysign(1 / (s.sets[0].full - s.sets[0].none), strength);  // one ball
  h.value = h.strength * s.full;
  if (h.nature == Nature::kPhysics) h.sets = diagnose::sets_at(s, h.strength);
  return h;
}

Hidden hide(const UnknownEffect& e, Random& random) {
  const double strength = random.uniform(kWeakest, kStrongest);
  return {e.name, Nature::kUnknown, strength, e.parameter, strength * e.full, {}};
}

std::vector<Recipe> singles(const DrawPlan& plan, const std::function<bool(const Suspect&)>& wanted) {
  std::vector<Recipe> recipes;
  for (const Suspect& s : diagnose::suspects_of(plan.mill)) {
    if (s.turns_with_drum || !wanted(s)) continue;  // a kind of its own
    if (plan.tier == Tier::kScalars &&
        std::find(kUnseenInScalars.begin(), kUnseenInScalars.end(), s.name) != kUnseenInScalars.end())
      continue;
    recipes.push_back([s](Random& random) { return std::vector{hide(s, random)}; });
  }
  return recipes;
}

bool is_physics(const Suspect& s) { return s.kind == SuspectKind::kPhysics; }

std::vector<Recipe> pairs(const DrawPlan& plan) {
  const std::vector<Recipe> one = singles(plan, is_physics);
  std::vector<Recipe> recipes;
  for (std::size_t a = 0; a < one.size(); ++a)
    for (std::size_t b = a + 1; b < one.size(); ++b)
      recipes.push_back([first = one[a], second = one[b]](Random& random) {
        std::vector<Hidden> both = first(random);
        both.push_back(second(random).front());
        return both;
      });
  return recipes;
}

Hidden missing(int count, int lifters, Random& random) {
  std::vector<std::uint64_t> gone;
  while (gone.size() < static_cast<std::size_t>(count)) {
    const std::uint64_t lifter = random.below(static_cast<std::uint64_t>(lifters));
    if (std::find(gone.begin(), gone.end(), lifter) == gone.end()) gone.push_back(lifter);
  }
  std::sort(gone.begin(), gone.end());
  std::string list;
  for (const std::uint64_t lifter : gone) list += fmt::format("{}{}", list.empty() ? "" : ", ", lifter);
  return {"missing_lifters", Nature::kPhysics, 1,
          "lifters",         double(count),    {"effects.missing_lifters.lifters=[" + list + "]"}};
}

Hidden one_worn(Suspect wear, int lifters, Random& random) {
  wear.fixed = {fmt::format("effects.lifter_wear.lifters=[{}]", random.below(static_cast<std::uint64_t>(lifters)))};
  const double strength = random.uniform(kLeastWorn, kStrongest);
  return {wear.name,      Nature::kPhysics,     strength,
          wear.parameter, strength * wear.full, diagnose::sets_at(wear, strength)};
}

Hidden ripple(Suspect drive, Random& random) {
  drive.fixed = {fmt::format("effects.speed_ripple.order={}", 1 + random.below(kMostRipples)),
                 fmt::format("effects.speed_ripple.phase_deg={:.1f}", random.uniform(0, 360))};
  return hide(drive, random);
}

// Averages over the turn are blind to these: lifters that are gone, one or two, a single worn one, ripple of the speed.
std::vector<Recipe> turn_locked(const DrawPlan& plan) {
  std::vector<Recipe> recipes;
  const int lifters = plan.mill.mill.lifters.count;
  for (const Suspect& s : diagnose::suspects_of(plan.mill)) {
    if (!s.turns_with_drum) continue;
    if (s.name == "lifter_wear")
      recipes.push_back([=](Random& random) { return std::vector{one_worn(s, lifters, random)}; });
    else if (s.name == "speed_ripple")
      recipes.push_back([=](Random& random) { return std::vector{ripple(s, random)}; });
    else
      for (const int count : {1, 2})
        recipes.push_back([=](Random& random) { return std::vector{missing(count, lifters, random)}; });
  }
  return recipes;
}

std::vector<Recipe> recipes_of(Kind kind, const DrawPlan& plan) {
  switch (kind) {
    case Kind::kNone:
      return {[](Random&) { return std::vector<Hidden>(); }};
    case Kind::kSingle:
      return singles(plan, [](const Suspect&) { return true; });
    case Kind::kPhysics:
      return singles(plan, is_physics);
    case Kind::kArtefact:
      return singles(plan, [](const Suspect& s) { return !is_physics(s); });
    case Kind::kHard:
      return singles(plan,
                     [](const Suspect& s) { return std::find(kHard.begin(), kHard.end(), s.name) != kHard.end(); });
    case Kind::kPair:
      return pairs(plan);
    case Kind::kTurnLocked:
      return turn_locked(plan);
    case Kind::kUnknown:
      break;
  }
  std::vector<Recipe> recipes;
  for (const UnknownEffect& e : unknown_effects())
    recipes.push_back([&e](Random& random) { return std::vector{hide(e, random)}; });
  return recipes;
}

template <class T>
void shuffle(std::vector<T>& list, Random& random) {
  for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[random.below(i)]);
}

// The values that the mill really has. Those that no mill can have are drawn again.
std::vector<std::pair<std::string, double>> draw_uncertain(const DrawPlan& plan, Random& random) {
  constexpr int kTries = 1000;
  for (int k = 0; k < kTries; ++k) {
    std::vector<std::pair<std::string, double>> values;
    std::vector<std::string> sets;
    for (const UncertainKey& u : plan.uncertain) {
      double z = gaussian(random);
      while (std::abs(z) > kFarthest) z = gaussian(random);
      values.emplace_back(u.key, io::number_at(plan.mill, u.key) + z * u.sd);
      sets.push_back(fmt::format("{}={}", u.key, values.back().second));
    }
    try {
      check_complete(io::with_sets(plan.mill, sets));
      return values;
    } catch (const InputError&) {
    }
  }
  throw InputError("--uncertain", "takes the mill where it cannot be; give smaller standard deviations");
}

}  // namespace

std::vector<TrialKey> draw_keys(const DrawPlan& plan, const std::function<std::uint64_t()>& entropy) {
  for (const UncertainKey& u : plan.uncertain) {
    if (u.key.starts_with("mill.speed") || u.key == "charge.filling" || u.key == "charge.count")
      throw InputError("--uncertain: " + u.key,
                       "is what each experiment sets; speed_error and filling_error err in it");
    if (std::isnan(io::number_at(plan.mill, u.key)))
      throw InputError("--uncertain: " + u.key, "has no number in this mill; give it one in MILL.toml");
  }
  Random random(entropy());
  std::vector<TrialKey> keys(plan.n);
  std::vector<std::vector<Recipe>> recipes, left;
  for (const Kind kind : plan.kinds) {
    recipes.push_back(recipes_of(kind, plan));
    if (recipes.back().empty())
      throw InputError("--kind", fmt::format("{}: nothing of it can be in this mill; leave it out", name_of(kind)));
  }
  left.resize(recipes.size());
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < plan.n; ++i) order.push_back(i % plan.kinds.size());
  shuffle(order, random);
  for (std::size_t i = 0; i < plan.n; ++i) {
    const std::size_t k = order[i];
    if (left[k].empty()) shuffle(left[k] = recipes[k], random);
    TrialKey& key = keys[i];
    key.name = fmt::format("{:04}", i + 1);
    for (int word = 0; word < 4; ++word) key.salt += fmt::format("{:016x}", entropy());
    key.kind = plan.kinds[k];
    key.tier = plan.tier;
    Random own(entropy());
    key.hidden = left[k].back()(own);
    left[k].pop_back();
    key.uncertain = draw_uncertain(plan, own);
    key.seed = entropy();
  }
  return keys;
}

}  // namespace tumble::trials
