#include "diagnose/suspects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/effects.h"
#include "core/units.h"

namespace tumble::diagnose {
namespace {

constexpr double kMost = 1.5;     // times full strength
constexpr double kOneWorn = 0.5;  // full strength of a single lifter's wear, share of its height

// Full strengths of artefacts: what happens to careful people.
constexpr double kScale = 0.02, kRotationDeg = 2, kClock = 0.02, kFilling = 0.05, kSpeed = 0.03, kTorque = 0.036;

Suspect of_effect(const Effect& effect) {
  Suspect s;
  s.name = effect.name;
  s.acts_in_contacts = std::string_view(effect.acts_on) == "contact";
  for (const EffectParameter& p : effect.parameters) {
    // The first strength is what is asked for; another that has a typical value goes with it.
    if (!p.strength || p.list || std::isnan(p.typical) || !(p.typical != 0)) continue;
    if (s.sets.empty()) {
      s.parameter = p.name;
      s.unit = p.unit;
      s.full = p.typical;
      s.high = std::min(kMost, p.most / p.typical);
      // A change that may be either way is looked at both ways.
      if (p.least < 0) s.low = std::max(-kMost, p.least / p.typical);
    }
    s.sets.push_back({fmt::format("effects.{}.{}", effect.name, p.name), 0, p.typical});
  }
  return s;
}

Suspect seen(const char* name, const char* parameter, const char* unit, double full, const Observer& observer) {
  Suspect s;
  s.name = name;
  s.kind = SuspectKind::kArtefact;
  s.low = -kMost;
  s.high = kMost;
  s.parameter = parameter;
  s.unit = unit;
  s.full = full;
  s.observer = observer;
  return s;
}

Suspect misjudged(const char* name, const char* unit, const std::string& key, double value, double share, bool whole) {
  Suspect s = seen(name, "relative", unit, share, {});
  s.sets.push_back({key, value, value * (1 + share), whole});
  return s;
}

Suspect lost_lifter() {
  Suspect s;
  s.name = "missing_lifters";
  s.variant = "one lifter";
  s.low = s.high = 1;
  s.parameter = "count";
  s.fixed.push_back("effects.missing_lifters.lifters=[0]");
  s.turns_with_drum = true;
  return s;
}

}  // namespace

std::vector<Suspect> suspects_of(const Config& mill) {
  std::vector<Suspect> list;
  for (const Effect& effect : all_effects()) {
    if (has_effect(mill, effect.name)) continue;
    Suspect s = of_effect(effect);
    // A table can say anything; missing lifters come below.
    if (s.sets.empty()) continue;
    if (s.name == "hertz_contact" && mill.contact.law == ContactLaw::kHertz) continue;
    const bool no_lifters = mill.mill.lifters.profile == LifterProfile::kNone;
    if (s.name == "lifter_wear" && no_lifters) continue;
    s.turns_with_drum = s.name == "speed_ripple";  // of one ripple in a revolution; others show in the mill's angle
    list.push_back(s);
    if (s.name != "lifter_wear") continue;
    s.variant = "one lifter";
    s.turns_with_drum = true;
    s.fixed.push_back("effects.lifter_wear.lifters=[0]");
    s.full = s.sets.front().full = kOneWorn;
    list.push_back(std::move(s));
  }
  if (mill.mill.lifters.profile != LifterProfile::kNone && mill.mill.lifters.count > 1 &&
      !has_effect(mill, "missing_lifters"))
    list.push_back(lost_lifter());
  list.push_back(seen("camera_scale", "relative", "", kScale, {kScale, 0, 0}));
  list.push_back(seen("camera_rotation", "angle_deg", "deg", kRotationDeg, {0, kRotationDeg * kPi / 180, 0}));
  list.push_back(seen("frame_clock", "relative", "", kClock, {0, 0, kClock}));
  if (mill.charge.count)
    list.push_back(misjudged("filling_error", "", "charge.count", *mill.charge.count, kFilling, true));
  else
    list.push_back(misjudged("filling_error", "", "charge.filling", mill.charge.filling, kFilling, false));
  const bool by_share = !std::isnan(mill.mill.speed);
  list.push_back(misjudged("speed_error", "", by_share ? "mill.speed" : "mill.speed_rpm",
                           by_share ? mill.mill.speed : mill.mill.speed_rpm, kSpeed, false));
  Suspect torque = seen("torque_offset", "relative", "", kTorque, {});
  torque.torque_offset = kTorque;
  list.push_back(std::move(torque));
  return list;
}

std::vector<std::string> sets_at(const Suspect& suspect, double strength) {
  std::vector<std::string> sets;
  for (const Suspect::Set& s : suspect.sets) {
    double value = s.none + strength * (s.full - s.none);
    if (s.whole) value = std::round(value);
    sets.push_back(fmt::format("{}={}", s.key, value));
  }
  if (strength != 0) sets.insert(sets.end(), suspect.fixed.begin(), suspect.fixed.end());
  return sets;
}

double strength_of_sets(const Suspect& suspect, double strength) {
  for (const Suspect::Set& s : suspect.sets)
    if (s.whole) return (std::round(s.none + strength * (s.full - s.none)) - s.none) / (s.full - s.none);
  return strength;
}

}  // namespace tumble::diagnose
