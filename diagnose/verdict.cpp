#include "diagnose/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/mill_shape.h"
#include "core/statistics.h"
#include "diagnose/account.h"
#include "diagnose/exact_checks.h"
#include "diagnose/further.h"
#include "diagnose/observe.h"
#include "diagnose/proofs.h"
#include "diagnose/rivals.h"
#include "diagnose/ruling.h"

namespace tumble::diagnose {
namespace {

constexpr int kRounds = 3;              // of simulating anew where the last round says that the likeliest lie
constexpr double kBehind = 12;          // ln: further behind, the polynomial's errors do not bring an accusation back
constexpr std::size_t kMostTried = 4;   // accusations in the first round, beside that of nobody
constexpr std::size_t kTriedAgain = 2;  // in the further ones
constexpr std::array kShares{0.55, 0.15, 0.1, 0.1};  // of the time: each round, and what is held out
constexpr double kShownShare = 0.9;                  // then what to measure next
constexpr double kHeard = 3;                         // ln of the rarity from which a ripple is no chance
constexpr double kRarest = 1e-30;

std::vector<Scene> scenes_of(const DiagnosisRequest& r) {
  std::vector<Scene> scenes;
  double torque = 0, fitted = 0;
  for (const Measurement& m : r.measurements) {
    if (m.experiment.hold_out || std::isnan(m.torque.value)) continue;
    torque += m.torque.value;
    fitted += 1;
  }
  const auto& names = r.conditions.front().suspects;
  for (const Measurement& m : r.measurements) {
    Scene scene{&m, suspects_of(m.config), r.middle, span_of(m), fitted > 0 ? torque / fitted : 0};
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

DiagnosedExperiment described(const Measurement& m) {
  const Experiment& e = m.experiment;
  std::string data;
  const auto add = [&](bool there, const char* what) {
    if (there) data += (data.empty() ? "" : ", ") + std::string(what);
  };
  add(!std::isnan(m.torque.value), m.torque_series.empty() ? "torque" : "torque in time");
  add(!std::isnan(e.toe_deg.value) || !std::isnan(e.shoulder_deg.value), "toe and shoulder");
  add(!m.frames.empty(), m.is_film ? "film" : "tracks of balls");
  return {e.name,
          data,
          e.hold_out,
          speed_fraction(m.config.mill),
          filling_of(m.config, class_counts(m.config)),
          make_mill_shape(m.config),
          {}};
}

// A mill's angle tells of ripples in its speed, of any order and phase, what no map of the charge shows. The one that
// stands out in the fitted experiments; 0 where none does.
int order_of_ripple(const std::vector<Scene>& scenes, const std::vector<std::vector<RippleOrder>>& orders) {
  std::map<int, double> rarity;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (scenes[i].measurement->experiment.hold_out) continue;
    for (const RippleOrder& r : orders[i]) rarity[r.order] -= std::log(std::max(r.p, kRarest));
  }
  int order = 0;
  double most = kHeard + std::log(std::max<double>(1, double(rarity.size())));
  for (const auto& [n, rare] : rarity)
    if (rare > most) most = rare, order = n;
  return order;
}

// The ripple that is suspected becomes the one that is seen; what its amplitude is, a clue tells.
void tell_ripple(Scene& scene, const std::vector<RippleOrder>& orders, int order, std::vector<Clue>& clues) {
  const auto at = std::find_if(scene.suspects.begin(), scene.suspects.end(),
                               [](const Suspect& s) { return s.name == "speed_ripple"; });
  if (at == scene.suspects.end() || orders.empty()) return;
  const RippleOrder& r = orders[static_cast<std::size_t>(std::max(1, order) - 1)];
  if (order > 0) {
    at->turns_with_drum = false;
    at->fixed = {fmt::format("effects.speed_ripple.order={}", r.order),
                 fmt::format("effects.speed_ripple.phase_deg={:.1f}", r.phase_deg)};
  }
  if (scene.measurement->experiment.hold_out || !(r.se > 0) || !std::isfinite(r.amplitude)) return;
  // Noise makes any amplitude larger.
  const double amplitude = std::sqrt(std::max(0.0, r.amplitude * r.amplitude - 2 * r.se * r.se));
  clues.push_back({{{static_cast<int>(at - scene.suspects.begin()), at->full}}, amplitude, r.se});
}

// Checks that only errors of measurement can move, and that no map of the charge repeats.
std::vector<Clue> clues_of(const std::vector<ExactCheck>& checks, std::span<const Suspect> suspects) {
  std::vector<Clue> clues;
  for (const ExactCheck& check : checks) {
    if (check.name.starts_with("flight") || check.moved_by.empty() || !(check.se > 0) || !std::isfinite(check.z))
      continue;
    Clue clue{{}, check.found - check.expected, check.se};
    bool clean = true;
    for (const MovedBy& by : check.moved_by) {
      const auto at =
          std::find_if(suspects.begin(), suspects.end(), [&](const Suspect& s) { return s.name == by.suspect; });
      clean = clean && at != suspects.end() && at->kind == SuspectKind::kArtefact && !std::isnan(by.per);
      if (clean) clue.slopes.emplace_back(static_cast<int>(at - suspects.begin()), at->full / by.per);
    }
    if (clean) clues.push_back(std::move(clue));
  }
  return clues;
}

// The likeliest accusations, put to the proof until they lie where they were simulated.
class Court {
 public:
  Court(const std::vector<Scene>& scenes, const std::vector<Fitted>& fitted, const Case& of, const Bench& bench,
        const Progress& progress)
      : scenes_(scenes),
        fitted_(fitted),
        of_(of),
        bench_(bench),
        progress_(progress),
        keys_(scenes.front().middle.size()),
        posterior_(weigh(of)) {}

  void hear() {
    for (int round = 0; round < kRounds; ++round) {
      const std::vector<Accusation> summoned = summon(round == 0);
      for (std::size_t i = 0; i < summoned.size(); ++i) try_one(summoned[i], stage(round, i, summoned.size()));
      if (summoned.empty()) break;
      weigh_all_again();
    }
  }

  // The likeliest accusation of exactly these, put to the proof if it was not.
  Proof* prove(const std::set<std::string>& names) {
    for (const Accusation& a : posterior_.accusations) {
      if (names_of(a, of_.suspects) != names) continue;
      const std::vector<int> suspects = a.explanation.suspects;
      if (proofs_.find(suspects) == proofs_.end()) try_one(a, {});
      return proof_of(suspects);
    }
    return nullptr;
  }

  // The same in what is held out.
  void cross_examine(const std::vector<Proof*>& proofs) {
    for (std::size_t i = 0; i < proofs.size(); ++i)
      simulations_ += simulate(*proofs[i], bench_, true, stage(kRounds, i, proofs.size()));
  }

  Proof* proof_of(const std::vector<int>& suspects) {
    const auto at = proofs_.find(suspects);
    return at == proofs_.end() ? nullptr : &at->second;
  }
  const Posterior& posterior() const { return posterior_; }
  std::size_t simulations() const { return simulations_; }

 private:
  void try_one(const Accusation& accusation, const Progress& stage) {
    Proof proof = diagnose::proof_of(accusation, scenes_.size(), keys_);
    simulations_ += simulate(proof, bench_, false, stage);
    find_errors(errors_, proof, fitted_, scenes_);
    proofs_[accusation.explanation.suspects] = std::move(proof);
  }

  void weigh_all_again() {
    for (Accusation& a : posterior_.accusations) a = weighed_again(a, corrected(of_, errors_, a.explanation));
    for (const Accusation& a : posterior_.accusations)
      if (const auto at = proofs_.find(a.explanation.suspects); at != proofs_.end()) at->second.accusation = a;
    settle(posterior_, of_);
  }

  std::vector<Accusation> summon(bool first) const {
    std::vector<Accusation> list;
    const auto add = [&](const std::vector<int>& suspects) {
      const auto is_it = [&](const Accusation& a) { return a.explanation.suspects == suspects; };
      if (std::any_of(list.begin(), list.end(), is_it)) return;
      const auto known = proofs_.find(suspects);
      if (known != proofs_.end() && (first || !has_moved(known->second, keys_))) return;
      const auto at = std::find_if(posterior_.accusations.begin(), posterior_.accusations.end(), is_it);
      if (at != posterior_.accusations.end()) list.push_back(*at);
    };
    const Accusation& best = posterior_.accusations.front();
    const std::set<std::string> names = names_of(best, of_.suspects);
    std::size_t tried = 0, others = 0;
    if (first) add({});
    for (const Accusation& a : posterior_.accusations) {
      const bool other = names_of(a, of_.suspects) != names && !a.explanation.suspects.empty();
      // One rival at least, however far behind: the repair must be better than that.
      if (tried >= (first ? kMostTried : kTriedAgain) || (a.log_weight < best.log_weight - kBehind && others > 0))
        break;
      ++tried;
      others += other;
      add(a.explanation.suspects);
    }
    return list;
  }

  Progress stage(int round, std::size_t part, std::size_t parts) const {
    if (!progress_) return {};
    double before = 0;
    for (int r = 0; r < round; ++r) before += kShares[static_cast<std::size_t>(r)];
    const double share = kShares[static_cast<std::size_t>(round)];
    return [this, before, share, part, parts](double done) {
      progress_(before + share * (double(part) + done) / double(parts));
    };
  }

  const std::vector<Scene>& scenes_;
  const std::vector<Fitted>& fitted_;
  const Case& of_;
  const Bench& bench_;
  const Progress& progress_;
  std::size_t keys_;
  Posterior posterior_;
  std::map<std::vector<int>, Proof> proofs_;  // by suspects
  FoundErrors errors_;                        // by all that was simulated
  std::size_t simulations_ = 0;
};

Progress share_of(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double done) { progress(from + done * (to - from)); };
}

}  // namespace

Diagnosis find_out(const DiagnosisRequest& request, const MillWith& mill_with, const Progress& progress) {
  std::vector<Scene> scenes = scenes_of(request);
  std::vector<std::vector<RippleOrder>> ripples;
  for (const Scene& scene : scenes) ripples.push_back(ripple_orders(*scene.measurement));
  const int order = order_of_ripple(scenes, ripples);
  std::vector<Clue> clues;
  for (std::size_t i = 0; i < scenes.size(); ++i) tell_ripple(scenes[i], ripples[i], order, clues);
  const std::vector<Suspect>& suspects = scenes.front().suspects;
  const int keys = static_cast<int>(request.uncertain.size());
  std::vector<Fitted> fitted;
  for (std::size_t i = 0; i < scenes.size(); ++i)
    if (!scenes[i].measurement->experiment.hold_out)
      fitted.push_back(fit(request.conditions[fitted.size()], scenes[i], i));
  Case of = case_of(fitted, scenes);
  of.clues = std::move(clues);
  Diagnosis d;
  for (const Measurement& m : request.measurements) {
    const std::vector<ExactCheck> checks = exact_checks(m);
    for (const ExactCheck& c : checks)
      d.checks.push_back({c.experiment, c.name, c.unit, c.found, c.expected, c.se, c.z, c.says});
    if (m.experiment.hold_out) continue;
    for (Clue& clue : clues_of(checks, suspects)) of.clues.push_back(std::move(clue));
  }
  d.alike = alike(of.by_lifter.front(), suspects);

  const Bench bench{&scenes, &request.uncertain, &mill_with, request.seeds};
  Court court(scenes, fitted, of, bench, progress);
  court.hear();
  const Posterior& posterior = court.posterior();
  const Ruling ruling = rule(posterior, suspects);
  d.finding = ruling.finding;
  std::vector<std::string> experiments;  // fitted
  for (const Fitted& f : fitted) experiments.push_back(scenes[f.scene].measurement->experiment.name);
  d.ranking = ranking_of(posterior, suspects, keys, experiments);
  d.effects = effects_of(ruling, posterior, suspects, keys);

  Proof* const before = court.proof_of({});
  const bool added = ruling.finding == Finding::kMissingEffect || ruling.finding == Finding::kMeasurementArtefact;
  Proof *after = added ? court.prove(ruling.names) : before, *runner_up = nullptr;
  for (const Accusation& a : posterior.accusations) {
    Proof* const proof = court.proof_of(a.explanation.suspects);
    if (proof == nullptr || a.explanation.suspects.empty() || names_of(a, suspects) == ruling.names) continue;
    runner_up = proof;
    break;
  }
  std::vector<Proof*> shown{before};
  if (after != before) shown.push_back(after);
  if (runner_up != nullptr) shown.push_back(runner_up);
  court.cross_examine(shown);
  if (runner_up != nullptr) d.runner_up = joined(names_of(runner_up->accusation, suspects));
  give_account(d, scenes, *before, *after, runner_up);
  for (const Scene& scene : scenes) {
    d.experiments.push_back(described(*scene.measurement));
    d.experiments.back().before = sets_of(scene, request.uncertain, before->model);
  }
  d.simulations = static_cast<int>(court.simulations());
  if (d.finding == Finding::kAmbiguous)
    d.next = what_next(posterior, request.conditions, fitted, bench, share_of(progress, kShownShare, 1));

  const Explanation& believed = after->accusation.explanation;
  for (int k = 0; k < keys; ++k) {
    const UncertainKey& key = request.uncertain[static_cast<std::size_t>(k)];
    const double given = request.middle[static_cast<std::size_t>(k)];
    d.keys.push_back({key.key, given, key.sd, {given + believed.places[k] * key.sd, believed.se(k) * key.sd}});
  }
  return d;
}

}  // namespace tumble::diagnose
