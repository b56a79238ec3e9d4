#include "diagnose/ruling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble::diagnose {
namespace {

constexpr double kSure = 0.9;                     // probability of one name beside which the others are no rivals
constexpr double kRuledOut = 0.01, kClearly = 9;  // probability; chi2
constexpr double kCredible = 0.95;
constexpr double kHidden = 0.35;  // error of a strength beside which half the full one does not show

NameKind kind_of(const Suspect& suspect) {
  return suspect.kind == SuspectKind::kPhysics ? NameKind::kPhysics : NameKind::kArtefact;
}

FoundParameter strength_in_units(const Suspect& suspect, const Explanation& e, int place) {
  return {suspect.parameter, suspect.unit, {e.places[place] * suspect.full, e.se(place) * suspect.full}};
}

// The experiment that speaks most against an explanation, where it is as good as ruled out.
std::string ruled_out_by(const Explanation& e, const Explanation& best, double probability,
                         const std::vector<std::string>& experiments) {
  if (probability > kRuledOut) return {};
  std::size_t worst = 0;
  for (std::size_t c = 1; c < experiments.size(); ++c)
    if (e.chi2_of[c] - best.chi2_of[c] > e.chi2_of[worst] - best.chi2_of[worst]) worst = c;
  return e.chi2_of[worst] - best.chi2_of[worst] > kClearly ? experiments[worst] : std::string();
}

// Suspects that turn with the drum are simulated at lifter 0, wherever they are.
std::string at_lifter(std::string set, int lifter) {
  const std::string first = "lifters=[0]";
  if (set.ends_with(first)) set.replace(set.size() - first.size(), first.size(), fmt::format("lifters=[{}]", lifter));
  return set;
}

// Those of whom these data would show little, were they guilty.
std::set<std::string> hidden(const Posterior& p, std::span<const Suspect> suspects) {
  std::set<std::string> names;
  for (const Accusation& a : p.accusations) {
    const Explanation& e = a.explanation;
    const auto keys = static_cast<int>(e.places.size()) - static_cast<int>(suspects.size());
    if (e.suspects.size() == 1 && a.probability > kRuledOut && e.se(keys + e.suspects.front()) > kHidden)
      names.merge(names_of(a, suspects));
  }
  return names;
}

}  // namespace

std::set<std::string> names_of(const Accusation& a, std::span<const Suspect> suspects) {
  std::set<std::string> names;
  for (const int s : a.explanation.suspects) names.insert(suspects[static_cast<std::size_t>(s)].name);
  return names;
}

std::vector<RankedName> ranking_of(const Posterior& p, std::span<const Suspect> suspects, int keys,
                                   const std::vector<std::string>& experiments) {
  std::vector<RankedName> ranking;
  std::set<std::string> done;
  for (std::size_t s = 0; s < suspects.size(); ++s) {
    if (!done.insert(suspects[s].name).second) continue;
    RankedName r{suspects[s].name, kind_of(suspects[s]), p.inclusion(suspects, suspects[s].name), {}, kNotGiven, {}};
    for (const Accusation& a : p.accusations) {  // likeliest first
      if (names_of(a, suspects) != std::set<std::string>{r.name}) continue;
      const int guilty = a.explanation.suspects.front();
      r.strength = strength_in_units(suspects[static_cast<std::size_t>(guilty)], a.explanation, keys + guilty);
      r.misfit = std::sqrt(a.explanation.chi2 / a.explanation.numbers);
      break;
    }
    ranking.push_back(std::move(r));
  }
  const Explanation& best = p.accusations.front().explanation;
  for (RankedName& r : ranking)
    for (const Accusation& a : p.accusations)
      if (names_of(a, suspects) == std::set<std::string>{r.name}) {
        r.ruled_out_by = ruled_out_by(a.explanation, best, r.probability, experiments);
        break;
      }
  ranking.push_back({"none", NameKind::kNone, p.none(), {}, kNotGiven, {}});
  ranking.push_back({"unknown", NameKind::kUnknown, p.unknown, {}, kNotGiven, {}});
  for (const Accusation& a : p.accusations)
    if (a.explanation.suspects.empty())
      ranking[ranking.size() - 2].misfit = std::sqrt(a.explanation.chi2 / a.explanation.numbers);
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const RankedName& a, const RankedName& b) { return a.probability > b.probability; });
  return ranking;
}

std::string joined(const std::set<std::string>& names) { return fmt::format("{}", fmt::join(names, " + ")); }

Ruling rule(const Posterior& p, std::span<const Suspect> suspects) {
  if (p.unknown > 0.5) return {Finding::kUnknownEffect, {}};
  std::vector<std::pair<std::set<std::string>, double>> sets;  // of names, likeliest first
  for (const Accusation& a : p.accusations) {
    const std::set<std::string> names = names_of(a, suspects);
    const auto at = std::find_if(sets.begin(), sets.end(), [&](const auto& s) { return s.first == names; });
    if (at == sets.end())
      sets.emplace_back(names, a.probability);
    else
      at->second += a.probability;
  }
  std::stable_sort(sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  const auto& [best, probability_of_best] = sets.front();
  const double known = 1 - p.unknown;
  const bool likeliest = std::all_of(suspects.begin(), suspects.end(),
                                     [&](const Suspect& s) { return p.inclusion(suspects, s.name) < p.none(); });
  std::set<std::string> open;
  if (best.empty()) open = hidden(p, suspects);
  if (best.empty() && likeliest && open.empty()) return {Finding::kAgreement, {}};
  // Where not all that is named is sure, those without whom hardly anything likely does.
  std::set<std::string> sure;
  if (probability_of_best >= kSure * known)
    sure = best;
  else
    for (const std::string& name : best)
      if (p.inclusion(suspects, name) >= kSure * known) sure.insert(name);
  if (!sure.empty()) {
    const bool artefacts = std::all_of(sure.begin(), sure.end(), [&](const std::string& name) {
      return std::any_of(suspects.begin(), suspects.end(),
                         [&](const Suspect& s) { return s.name == name && s.kind == SuspectKind::kArtefact; });
    });
    return {artefacts ? Finding::kMeasurementArtefact : Finding::kMissingEffect, sure};
  }
  Ruling ruling{Finding::kAmbiguous, std::move(open)};
  double sum = p.unknown;
  for (const auto& [names, probability] : sets) {
    if (sum >= kCredible) break;
    ruling.names.insert(names.begin(), names.end());
    sum += probability;
  }
  return ruling;
}

std::vector<FoundEffect> effects_of(const Ruling& ruling, const Posterior& p, std::span<const Suspect> suspects,
                                    int keys) {
  std::vector<FoundEffect> effects;
  for (const std::string& name : ruling.names) {
    FoundEffect effect{name, NameKind::kPhysics, {}, p.inclusion(suspects, name), {}};
    for (const Accusation& a : p.accusations) {  // the likeliest that names it
      if (!names_of(a, suspects).contains(name)) continue;
      for (const int s : a.explanation.suspects) {
        const Suspect& suspect = suspects[static_cast<std::size_t>(s)];
        if (suspect.name != name) continue;
        effect.kind = kind_of(suspect);
        effect.parameters.push_back(strength_in_units(suspect, a.explanation, keys + s));
        for (const std::string& set : sets_at(suspect, a.explanation.places[keys + s])) {
          if (!suspect.sets.empty() && set.starts_with(suspect.sets.front().key + "=")) continue;
          effect.sets.push_back(at_lifter(set, a.lifter));
        }
      }
      break;
    }
    effects.push_back(std::move(effect));
  }
  std::stable_sort(effects.begin(), effects.end(),
                   [](const FoundEffect& a, const FoundEffect& b) { return a.probability > b.probability; });
  return effects;
}

}  // namespace tumble::diagnose
