#include "diagnose/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "core/error.h"
#include "core/statistics.h"
#include "diagnose/observe.h"

namespace tumble::diagnose {
namespace {

constexpr double kSure = 0.9;  // probability of one name beside which the others are no rivals
constexpr double kCredible = 0.95;
constexpr std::size_t kProven = 3;  // likeliest accusations that are simulated, beside that of nobody

struct Fitted {  // a measurement that is not held out, and what is known of its condition
  std::size_t scene = 0;
  std::unique_ptr<Response> response;
  std::vector<std::vector<double>> by_lifter;  // its numbers, the drum turned on
};

struct Proof {  // an accusation, simulated in all scenes
  Accusation accusation;
  Model model;
  std::vector<Replicas> runs;  // by scene
};

std::vector<Scene> scenes_of(const DiagnosisRequest& r) {
  std::vector<Scene> scenes;
  const auto& names = r.conditions.front().suspects;
  for (const Measurement& m : r.measurements) {
    Scene scene{&m, suspects_of(m.config), r.middle, span_of(m)};
    if (std::isnan(scene.span)) scene.span = kSpans.front();
    const bool alike = scene.suspects.size() == names.size() &&
                       std::equal(names.begin(), names.end(), scene.suspects.begin(),
                                  [](const Suspect& a, const Suspect& b) { return a.name == b.name; });
    if (!alike)
      throw InputError(m.experiment.place,
                       "sets what the other experiments do not (an effect, or lifters away); a diagnosis is of one "
                       "mill: leave it out, or diagnose it by itself");
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

Fitted fit(const Condition& condition, const Scene& scene, std::size_t index) {
  const ObservationLayout layout(scene.measurement->config.mill.lifters.count);
  const Observation seen = observe(*scene.measurement, layout, scene.span);
  std::vector<const SignatureRun*> runs;
  for (const SignatureRun& run : condition.runs) runs.push_back(&run);
  std::vector<std::vector<double>> shown;
  for (const SignatureRun* run : runs) shown.push_back(observed_at(run->seen, scene.span));
  std::vector<std::size_t> chosen;
  std::vector<double> noise;
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const bool told = std::all_of(shown.begin(), shown.end(), [&](const auto& s) { return !std::isnan(s[i]); });
    if (std::isnan(seen.value[i]) || !told) continue;
    chosen.push_back(i);
    noise.push_back(seen.noise[i]);
  }
  if (chosen.empty())
    throw InputError(scene.measurement->experiment.place,
                     "brings nothing that simulations of it show too; give torque, toe and shoulder, or a film");
  Fitted f{index, std::make_unique<Response>(runs, condition.suspects, chosen, noise, scene.span), {}};
  const bool turning = !std::isnan(seen.value[layout.first(Observable::kPockets)]);
  for (int l = 0; l < (turning ? layout.pockets : 1); ++l) f.by_lifter.push_back(turned_on(layout, seen.value, l));
  return f;
}

Case case_of(const std::vector<Fitted>& fitted, const std::vector<Scene>& scenes,
             const std::vector<Witness>& witnesses) {
  Case c;
  c.witnesses = witnesses;
  c.suspects = scenes.front().suspects;
  std::size_t lifters = fitted.front().by_lifter.size();
  for (const Fitted& f : fitted) lifters = std::min(lifters, f.by_lifter.size());
  for (std::size_t l = 0; l < lifters; ++l) {
    std::vector<Measured> measured;
    for (const Fitted& f : fitted) {
      const double watched = scenes[f.scene].measurement->revolutions;
      measured.push_back(
          {f.response.get(), f.response->whitened(f.by_lifter[l]), watched > 0 ? watched : f.response->revolutions()});
    }
    c.by_lifter.push_back(std::move(measured));
  }
  return c;
}

std::set<std::string> names_of(const Accusation& a, const std::vector<Suspect>& suspects) {
  std::set<std::string> names;
  for (const int s : a.explanation.suspects) names.insert(suspects[static_cast<std::size_t>(s)].name);
  return names;
}

// The accusation again, with the polynomial put right where its simulations lie.
void reconsider(Proof& proof, const std::vector<Fitted>& fitted, const std::vector<Scene>& scenes, const Case& of) {
  std::vector<Measured> measured = of.by_lifter[static_cast<std::size_t>(proof.accusation.lifter)];
  const auto keys = static_cast<Eigen::Index>(scenes.front().middle.size());
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const Scene& scene = scenes[fitted[i].scene];
    const auto& runs = proof.runs[fitted[i].scene];
    if (runs.seen.size() < 2) return;
    Eigen::VectorXd places = proof.model.places;
    for (std::size_t s = 0; s < scene.suspects.size(); ++s)
      if (!scene.suspects[s].is_simulated()) places[keys + static_cast<Eigen::Index>(s)] = 0;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(measured[i].seen.size());
    for (const auto& seen : runs.seen) mean += fitted[i].response->whitened(seen) / double(runs.seen.size());
    measured[i].shift = mean - fitted[i].response->at(places).mean;
    measured[i].shift_variance = 1 / double(runs.seen.size());
  }
  const Explanation again = explain(measured, of.suspects, proof.accusation.explanation.suspects);
  proof.accusation.log_weight += again.log_evidence - proof.accusation.explanation.log_evidence;
  proof.accusation.explanation = again;
}

NameKind kind_of(const Suspect& suspect) {
  return suspect.kind == SuspectKind::kPhysics ? NameKind::kPhysics : NameKind::kArtefact;
}

FoundParameter strength_in_units(const Suspect& suspect, const Explanation& e, int place) {
  return {suspect.parameter, suspect.unit, {e.places[place] * suspect.full, e.se(place) * suspect.full}};
}

// Of each name: how probable, and how strong it would be alone.
std::vector<RankedName> ranking_of(const Posterior& p, const std::vector<Suspect>& suspects, int keys) {
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
  ranking.push_back({"none", NameKind::kNone, p.none(), {}, kNotGiven, {}});
  ranking.push_back({"unknown", NameKind::kUnknown, p.unknown, {}, kNotGiven, {}});
  for (const Accusation& a : p.accusations)
    if (a.explanation.suspects.empty())
      ranking[ranking.size() - 2].misfit = std::sqrt(a.explanation.chi2 / a.explanation.numbers);
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const RankedName& a, const RankedName& b) { return a.probability > b.probability; });
  return ranking;
}

// The verdict that the probabilities come to, and whom it names.
struct Ruling {
  Finding finding = Finding::kAgreement;
  std::set<std::string> names;
};

Ruling rule(const Posterior& p, const std::vector<Suspect>& suspects) {
  if (p.unknown > 0.5) return {Finding::kUnknownEffect, {}};
  std::set<std::string> likeliest;
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
  const std::set<std::string>& best = sets.front().first;
  const double known = 1 - p.unknown;
  // Sure of what is named when hardly anything likely does without it.
  double agreeing = 0;
  for (const auto& [names, probability] : sets)
    if (std::includes(names.begin(), names.end(), best.begin(), best.end()) && (!best.empty() || names.empty()))
      agreeing += probability;
  if (agreeing >= kSure * known || sets.front().second >= kSure) {
    if (best.empty()) return {Finding::kAgreement, {}};
    const bool artefacts = std::all_of(best.begin(), best.end(), [&](const std::string& name) {
      return std::any_of(suspects.begin(), suspects.end(),
                         [&](const Suspect& s) { return s.name == name && s.kind == SuspectKind::kArtefact; });
    });
    return {artefacts ? Finding::kMeasurementArtefact : Finding::kMissingEffect, best};
  }
  if (best.empty() && sets.front().second > 0.5) return {Finding::kAgreement, {}};
  Ruling ruling{Finding::kAmbiguous, {}};
  double sum = p.unknown;
  for (const auto& [names, probability] : sets) {
    if (sum >= kCredible) break;
    ruling.names.insert(names.begin(), names.end());
    sum += probability;
  }
  return ruling;
}

Proof prove(const Accusation& a, const std::vector<Scene>& scenes, const DiagnosisRequest& r, const MillWith& mill_with,
            const Progress& progress) {
  Proof proof{a, {a.explanation.places, a.lifter}, {}};
  // Observers that nobody accuses err by nothing that is worth correcting.
  const auto keys = static_cast<Eigen::Index>(r.middle.size());
  for (std::size_t s = 0; s < scenes.front().suspects.size(); ++s) {
    const bool guilty = std::find(a.explanation.suspects.begin(), a.explanation.suspects.end(), static_cast<int>(s)) !=
                        a.explanation.suspects.end();
    if (!guilty) proof.model.places[keys + static_cast<Eigen::Index>(s)] = 0;
  }
  proof.runs = resimulate(scenes, r.uncertain, proof.model, r.seeds, mill_with, progress);
  return proof;
}

Progress share_of(const Progress& progress, std::size_t part, std::size_t parts) {
  if (!progress) return {};
  return [progress, part, parts](double done) { progress((double(part) + done) / double(parts)); };
}

// The places and gaps of every experiment, before and after.
class Account {
 public:
  Account(const std::vector<Scene>& scenes, const Proof& before, const Proof& after, const Proof* runner_up)
      : scenes_(scenes), before_(before), after_(after), runner_up_(runner_up) {}

  void fill(Diagnosis& d) const {
    for (std::size_t i = 0; i < scenes_.size(); ++i) fill(d, i);
    std::stable_sort(d.where.begin(), d.where.end(),
                     [](const PlaceOfGap& a, const PlaceOfGap& b) { return std::abs(a.z) > std::abs(b.z); });
  }

 private:
  void fill(Diagnosis& d, std::size_t index) const {
    const Scene& scene = scenes_[index];
    const Experiment& e = scene.measurement->experiment;
    const ObservationLayout layout(scene.measurement->config.mill.lifters.count);
    std::vector<const Replicas*> sets{&before_.runs[index], &after_.runs[index]};
    if (runner_up_ != nullptr) sets.push_back(&runner_up_->runs[index]);
    const std::vector<double> scatter = scatter_of(sets);
    if (scatter.empty()) return;
    const Contrast before = contrast(scene, before_.model, before_.runs[index], scatter),
                   after = contrast(scene, after_.model, after_.runs[index], scatter);
    GapRow row{e.name, e.hold_out, before.chi, after.chi, kNotGiven, slice_torque(*scene.measurement), {}, {}};
    if (runner_up_ != nullptr) row.runner_up = contrast(scene, runner_up_->model, runner_up_->runs[index], scatter).chi;
    row.torque_before = torque_of(before_.runs[index]);
    row.torque_after = torque_of(after_.runs[index]);
    d.gaps.push_back(row);

    std::vector<double> z_before(layout.size(), kNotGiven), z_after = z_before, measured = z_before,
                                                            shown_before = z_before, shown_after = z_before;
    for (std::size_t k = 0; k < before.numbers.size(); ++k) {
      z_before[before.numbers[k]] = before.z[k];
      measured[before.numbers[k]] = before.measured[k];
      shown_before[before.numbers[k]] = before.simulated[k];
    }
    for (std::size_t k = 0; k < after.numbers.size(); ++k) {
      z_after[after.numbers[k]] = after.z[k];
      shown_after[after.numbers[k]] = after.simulated[k];
    }
    for (const Observable o : kObservables) {
      const std::size_t first = layout.first(o), count = layout.count(o);
      const double limit = chance_limit(sets, scatter, first, count);
      double chi_before = 0, chi_after = 0, n = 0;
      for (std::size_t k = first; k < first + count; ++k) {
        if (std::isnan(z_before[k]) || std::isnan(z_after[k])) continue;
        chi_before += z_before[k] * z_before[k];
        chi_after += z_after[k] * z_after[k];
        n += 1;
        if (std::abs(z_before[k]) > limit)
          d.where.push_back({e.name, name_of(o), layout.region(k), z_before[k], z_after[k]});
      }
      if (n == 0) continue;
      chi_before = std::sqrt(chi_before / n);
      chi_after = std::sqrt(chi_after / n);
      // Worse by more than two standard errors of a root mean square of n numbers.
      if (chi_after > chi_before + 2 * chi_after / std::sqrt(2 * n))
        d.worse.push_back({e.name, name_of(o), chi_before, chi_after});
      add_map(d, e.name, o, layout, {measured, shown_before, shown_after, z_before, z_after}, limit);
    }
  }

  static Estimate torque_of(const Replicas& runs) {
    std::vector<Estimate> torques;
    for (const auto& seen : runs.seen) torques.push_back({seen[0], kNotGiven});
    return mean_of_repeats(torques);
  }

  static void add_map(Diagnosis& d, const std::string& experiment, Observable o, const ObservationLayout& layout,
                      const std::array<std::vector<double>, 5>& numbers, double limit) {
    const bool round = o == Observable::kPockets;
    if (!round && o != Observable::kOccupancy && o != Observable::kMomentum && o != Observable::kAgitation &&
        o != Observable::kSpin)
      return;
    const std::size_t parts = round || o == Observable::kMomentum ? 2 : 1, each = layout.count(o) / parts;
    constexpr std::array kNames{"", " x", " y"};
    for (std::size_t part = 0; part < parts; ++part) {
      GapMap map;
      map.experiment = experiment;
      map.observable = round ? (part == 0 ? "balls in the pockets" : "slip in the pockets")
                             : std::string(name_of(o)) + (parts == 2 ? kNames[1 + part] : kNames[0]);
      map.n = round ? 0 : kCells;
      map.cell = 2.0 / kCells;
      map.limit = limit;
      std::array<std::vector<double>*, 5> into{&map.measured, &map.before, &map.after, &map.z_before, &map.z_after};
      for (std::size_t which = 0; which < into.size(); ++which) {
        const auto from = numbers[which].begin() + static_cast<std::ptrdiff_t>(layout.first(o) + part * each);
        if (round) {
          into[which]->assign(from, from + static_cast<std::ptrdiff_t>(each));
          continue;
        }
        for (const int cell : layout.cell_at) into[which]->push_back(cell < 0 ? kNotGiven : from[cell]);
      }
      d.maps.push_back(std::move(map));
    }
  }

  const std::vector<Scene>& scenes_;
  const Proof &before_, &after_;
  const Proof* runner_up_;
};

void sort_again(Posterior& p, const std::vector<Proof>& proofs) {
  const double known = 1 - p.unknown;
  for (const Proof& proof : proofs)
    for (Accusation& a : p.accusations)
      if (a.explanation.suspects == proof.accusation.explanation.suspects) a = proof.accusation;
  double most = -INFINITY, sum = 0;
  for (const Accusation& a : p.accusations) most = std::max(most, a.log_weight);
  for (const Accusation& a : p.accusations) sum += std::exp(a.log_weight - most);
  for (Accusation& a : p.accusations) a.probability = known * std::exp(a.log_weight - most) / sum;
  std::stable_sort(p.accusations.begin(), p.accusations.end(),
                   [](const Accusation& a, const Accusation& b) { return a.log_weight > b.log_weight; });
}

const Proof* proof_of(const std::vector<Proof>& proofs, const std::vector<int>& suspects) {
  for (const Proof& p : proofs)
    if (p.accusation.explanation.suspects == suspects) return &p;
  return nullptr;
}

std::vector<FoundEffect> effects_of(const Ruling& ruling, const Posterior& p, const std::vector<Suspect>& suspects,
                                    int keys) {
  std::vector<FoundEffect> effects;
  for (const std::string& name : ruling.names) {
    FoundEffect effect{name, NameKind::kPhysics, {}, p.inclusion(suspects, name)};
    for (const Accusation& a : p.accusations) {  // the likeliest that names it
      if (!names_of(a, suspects).contains(name)) continue;
      for (const int s : a.explanation.suspects) {
        const Suspect& suspect = suspects[static_cast<std::size_t>(s)];
        if (suspect.name != name) continue;
        effect.kind = kind_of(suspect);
        effect.parameters.push_back(strength_in_units(suspect, a.explanation, keys + s));
        if (suspect.turns_with_drum && name != "speed_ripple")
          effect.parameters.push_back({"lifters", "", {double(a.lifter), kNotGiven}});
      }
      break;
    }
    effects.push_back(std::move(effect));
  }
  std::stable_sort(effects.begin(), effects.end(),
                   [](const FoundEffect& a, const FoundEffect& b) { return a.probability > b.probability; });
  return effects;
}

}  // namespace

Diagnosis find_out(const DiagnosisRequest& request, const MillWith& mill_with, const Progress& progress) {
  const std::vector<Scene> scenes = scenes_of(request);
  const std::vector<Suspect>& suspects = scenes.front().suspects;
  const int keys = static_cast<int>(request.uncertain.size());
  std::vector<Fitted> fitted;
  for (std::size_t i = 0; i < scenes.size(); ++i)
    if (!scenes[i].measurement->experiment.hold_out)
      fitted.push_back(fit(request.conditions[fitted.size()], scenes[i], i));
  const Case of = case_of(fitted, scenes, request.witnesses);
  Posterior posterior = weigh(of);

  // The likeliest, and that nothing is hidden, are put to the proof; what that shows puts the polynomial right.
  std::vector<Accusation> tried(
      posterior.accusations.begin(),
      posterior.accusations.begin() + static_cast<std::ptrdiff_t>(std::min(kProven, posterior.accusations.size())));
  const auto nobody = std::find_if(posterior.accusations.begin(), posterior.accusations.end(),
                                   [](const Accusation& a) { return a.explanation.suspects.empty(); });
  if (std::none_of(tried.begin(), tried.end(), [](const Accusation& a) { return a.explanation.suspects.empty(); }))
    tried.push_back(*nobody);
  std::vector<Proof> proofs;
  Diagnosis d;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    proofs.push_back(prove(tried[i], scenes, request, mill_with, share_of(progress, i, tried.size())));
    reconsider(proofs.back(), fitted, scenes, of);
    d.simulations += static_cast<int>(scenes.size() * request.seeds);
  }
  sort_again(posterior, proofs);

  const Ruling ruling = rule(posterior, suspects);
  d.finding = ruling.finding;
  d.ranking = ranking_of(posterior, suspects, keys);
  d.effects = effects_of(ruling, posterior, suspects, keys);
  const Proof* before = proof_of(proofs, {});
  const bool added = ruling.finding == Finding::kMissingEffect || ruling.finding == Finding::kMeasurementArtefact;
  const Proof *after = before, *runner_up = nullptr;
  for (const Accusation& a : posterior.accusations) {
    const Proof* proof = proof_of(proofs, a.explanation.suspects);
    if (proof == nullptr) continue;
    if (added && after == before && names_of(a, suspects) == ruling.names)
      after = proof;
    else if (runner_up == nullptr && !a.explanation.suspects.empty() && names_of(a, suspects) != ruling.names)
      runner_up = proof;
  }
  if (runner_up != nullptr)
    for (const std::string& name : names_of(runner_up->accusation, suspects))
      d.runner_up += (d.runner_up.empty() ? "" : " + ") + name;
  Account(scenes, *before, *after, runner_up).fill(d);

  const Explanation& believed = after->accusation.explanation;
  for (int k = 0; k < keys; ++k) {
    const UncertainKey& key = request.uncertain[static_cast<std::size_t>(k)];
    const double given = request.middle[static_cast<std::size_t>(k)];
    d.keys.push_back({key.key, given, key.sd, {given + believed.places[k] * key.sd, believed.se(k) * key.sd}});
  }
  return d;
}

}  // namespace tumble::diagnose
