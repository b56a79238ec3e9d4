#include "trials/score.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "diagnose/suspects.h"

namespace tumble::trials {
namespace {

constexpr double kTwoSided95 = 1.959964;
constexpr double kClaim = 0.95;        // a probability above it is a claim
constexpr std::size_t kFewRivals = 4;  // an answer that names more does not name "exactly the rivals"
constexpr std::array kHard{"hertz_contact", "wall_friction", "friction_weakening"};

using Names = std::set<std::string>;

Names truth_of(const Judged& t) {
  Names names;
  for (const Hidden& h : t.key.hidden) names.insert(h.nature == Nature::kUnknown ? "unknown" : h.name);
  if (names.empty()) names.insert("none");
  return names;
}

bool is_ambiguous(const Judged& t) { return t.verdict.verdict == "ambiguous"; }

// What the verdict names; "none" and "unknown" are names too.
Names named_by(const Judged& t) {
  if (t.verdict.verdict == "agreement") return {"none"};
  if (t.verdict.verdict == "unknown_effect") return {"unknown"};
  Names names;
  for (const Named& e : t.verdict.effects) names.insert(e.name);
  return names;
}

bool is_right(const Judged& t) { return !is_ambiguous(t) && named_by(t) == truth_of(t); }

bool holds(const Names& names, const Names& these) {
  return std::includes(names.begin(), names.end(), these.begin(), these.end());
}

bool first_is_right(const Judged& t) {
  if (!t.verdict.ranking.empty()) return truth_of(t).contains(t.verdict.ranking.front().name);
  return is_right(t);
}

bool is_scalar(const Judged& t) { return t.key.tier == Tier::kScalars; }
bool is_known(const Judged& t) { return t.key.kind != Kind::kUnknown && t.key.kind != Kind::kTurnLocked; }
bool is_single(const Judged& t) { return is_known(t) && t.key.hidden.size() == 1; }
// `hard` trials are there to have more of the hard ones, which would bend the mean of all.
bool is_even_single(const Judged& t) { return is_single(t) && t.key.kind != Kind::kHard; }
bool is_hard(const Judged& t) {
  return is_single(t) && std::find(kHard.begin(), kHard.end(), t.key.hidden[0].name) != kHard.end();
}

bool rivals_named(const Judged& t) {
  return first_is_right(t) || (is_ambiguous(t) && holds(named_by(t), truth_of(t)) && named_by(t).size() <= kFewRivals &&
                               t.verdict.has_next_experiment);
}

bool is_artefact(const std::string& name) {
  static const std::vector<diagnose::Suspect> suspects = diagnose::suspects_of({});
  return std::any_of(suspects.begin(), suspects.end(), [&](const diagnose::Suspect& s) {
    return s.name == name && s.kind == diagnose::SuspectKind::kArtefact;
  });
}

// A verdict that is missing or broken counts as wrong, in whatever way one can be.
bool is_broken(const Judged& t) { return t.verdict.verdict.empty(); }

// A plain answer all of whose names are of the wrong nature.
bool natures_confused(const Judged& t) {
  if (is_broken(t)) return true;
  if (t.verdict.verdict != "missing_effect" && t.verdict.verdict != "measurement_artefact") return false;
  const bool truth = is_artefact(t.key.hidden[0].name);
  return !t.verdict.effects.empty() && std::all_of(t.verdict.effects.begin(), t.verdict.effects.end(),
                                                   [&](const Named& e) { return is_artefact(e.name) != truth; });
}

bool names_a_second(const Judged& t) { return is_broken(t) || (!is_ambiguous(t) && named_by(t).size() > 1); }

bool says_agreement(const Judged& t) { return t.verdict.verdict == "agreement"; }
bool says_unknown(const Judged& t) { return t.verdict.verdict == "unknown_effect"; }

bool noticed(const Judged& t) {
  const Names names = named_by(t);
  return !names.empty() &&
         std::none_of(names.begin(), names.end(), [](const std::string& n) { return n == "none" || is_artefact(n); });
}

bool in_credible_set(const Judged& t) {
  Names set;
  double sum = 0;
  for (const Ranked& r : t.verdict.ranking) {
    set.insert(r.name);
    if ((sum += r.probability) >= kClaim) break;
  }
  return holds(set, truth_of(t));
}

bool no_false_certainty(const Judged& t) {
  return holds(named_by(t), truth_of(t)) && (!is_ambiguous(t) || t.verdict.has_next_experiment);
}

using Test = std::function<bool(const Judged&)>;

Measured share(const std::vector<Judged>& trials, const Test& of, const Test& is) {
  int n = 0, right = 0;
  for (const Judged& t : trials) {
    if (!of(t)) continue;
    ++n;
    right += is(t);
  }
  return share_of(right, n);
}

Measured claims(const std::vector<Judged>& trials) {
  int n = 0, right = 0;
  for (const Judged& t : trials) {
    const Names truth = truth_of(t);
    for (const Ranked& r : t.verdict.ranking) {
      if (is_scalar(t) || !(r.probability > kClaim)) continue;
      ++n;
      right += truth.contains(r.name) || (r.name == "unknown" && t.key.kind == Kind::kTurnLocked);
    }
  }
  return share_of(right, n);
}

// Of every effect that is named and rightly so: relative error of its strength, and the error in standard errors.
struct Strengths {
  std::vector<double> error, pull;
};
Strengths strengths(const std::vector<Judged>& trials) {
  Strengths s;
  for (const Judged& t : trials) {
    if (is_scalar(t) || is_ambiguous(t) || !is_known(t)) continue;
    for (const Hidden& h : t.key.hidden)
      for (const Named& e : t.verdict.effects) {
        const auto p = e.parameters.find(h.parameter);
        if (e.name != h.name || p == e.parameters.end() || std::isnan(p->second.value)) continue;
        s.error.push_back(std::abs(p->second.value / h.value - 1));
        if (p->second.se > 0) s.pull.push_back((p->second.value - h.value) / p->second.se);
      }
  }
  return s;
}

// Of the disagreement beyond chance (reduced chi 1) on what was held out. Where there was none, nothing can be closed.
std::vector<double> gaps_closed(const std::vector<Judged>& trials) {
  std::vector<double> closed;
  for (const Judged& t : trials)
    if (!is_scalar(t) && is_right(t) && t.verdict.gap_before > 1 && !std::isnan(t.verdict.gap_after))
      closed.push_back((t.verdict.gap_before - std::max(1.0, t.verdict.gap_after)) / (t.verdict.gap_before - 1));
  return closed;
}

std::string said(const Judged& t) {
  if (is_broken(t)) return "no verdict";
  const Names names = named_by(t);
  return (is_ambiguous(t) ? "ambiguous: " : "") + fmt::format("{}", fmt::join(names, is_ambiguous(t) ? ", " : " + "));
}

std::string hidden(const Judged& t) {
  Names names;  // of what is unknown, its own name
  for (const Hidden& h : t.key.hidden) names.insert(h.name);
  if (names.empty()) return "none";
  const std::string list = fmt::format("{}", fmt::join(names, " + "));
  return is_known(t) ? list : fmt::format("{} ({})", list, name_of(t.key.kind));
}

}  // namespace

Measured share_of(int right, int n) {
  if (n == 0) return {};
  const double p = double(right) / n, z2 = kTwoSided95 * kTwoSided95;
  const double middle = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = kTwoSided95 * std::sqrt(p * (1 - p) / n + z2 / (4.0 * n * n)) / (1 + z2 / n);
  return {p, std::max(0.0, middle - half), std::min(1.0, middle + half), n};
}

Measured quantile_with_interval(std::vector<double> values, double share) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto n = double(values.size());
  const auto at = [&](double rank) { return values[static_cast<std::size_t>(std::clamp(rank, 0.0, n - 1))]; };
  const double half = kTwoSided95 * std::sqrt(n * share * (1 - share));
  return {at(share * n), at(share * n - half), at(share * n + half), static_cast<int>(values.size())};
}

Measured spread_of(const std::vector<double>& values) {
  const auto n = double(values.size());
  if (n < 2) return {};
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  const double sd = std::sqrt(squares / (n - 1)), half = kTwoSided95 * sd / std::sqrt(2 * (n - 1));
  return {sd, std::max(0.0, sd - half), sd + half, static_cast<int>(values.size())};
}

bool Bar::met() const { return tried() && !(measured.value < least) && !(measured.value > most); }

Score score(const std::vector<Judged>& trials) {
  const auto seen = [](const Test& of) { return [of](const Judged& t) { return !is_scalar(t) && of(t); }; };
  const auto kind = [](Kind k) { return [k](const Judged& t) { return t.key.kind == k; }; };
  const auto tier = [](Tier k) { return [k](const Judged& t) { return t.key.tier == k && is_even_single(t); }; };
  const auto of_kind = [&](Kind k) { return seen(kind(k)); };
  const double no = kNotGiven;
  const Strengths s = strengths(trials);

  Score result;
  result.bars = {
      {"1", "single effects from tracks: the right name first", share(trials, tier(Tier::kTracks), first_is_right),
       0.95, no},
      {"2", "single effects from films: the right name first", share(trials, tier(Tier::kFilms), first_is_right), 0.90,
       no},
      {"3", "Hertz, wall friction, mu(v): right, or the rivals and what parts them",
       share(trials, seen(is_hard), rivals_named), 0.80, no},
      {"4", "nothing hidden: agreement", share(trials, of_kind(Kind::kNone), says_agreement), 0.97, no},
      {"5", "artefact taken for physics, or back",
       share(trials, seen([](const Judged& t) { return is_known(t) && !t.key.hidden.empty(); }), natures_confused), no,
       0.01},
      {"6a", "pairs: exactly both", share(trials, of_kind(Kind::kPair), is_right), 0.90, no},
      {"6b", "singles: a second one named as well", share(trials, seen(is_single), names_a_second), no, 0.03},
      {"7a", "claims above 0.95 that are right", claims(trials), 0.97, no},
      {"7b", "strengths: scatter in standard errors", spread_of(s.pull), 0.8, 1.3, false},
      {"8a", "strengths: relative error, median", quantile_with_interval(s.error, 0.5), no, 0.05},
      {"8b", "strengths: relative error, 90th percentile", quantile_with_interval(s.error, 0.9), no, 0.20},
      {"9a", "effects outside the list: unknown_effect", share(trials, of_kind(Kind::kUnknown), says_unknown), 0.90,
       no},
      {"9b", "unknown_effect where there is none",
       share(trials, seen(is_known), [](const Judged& t) { return is_broken(t) || says_unknown(t); }), no, 0.03},
      {"10", "faults that turn with the drum: noticed", share(trials, of_kind(Kind::kTurnLocked), noticed), 0.90, no},
      {"11", "excess gap closed on what was held out, median", quantile_with_interval(gaps_closed(trials), 0.5), 0.90,
       no},
      {"12", "right verdicts whose runner-up is worse on what was held out",
       share(trials, seen([](const Judged& t) { return is_right(t) && !std::isnan(t.verdict.gap_runner_up); }),
             [](const Judged& t) { return t.verdict.gap_runner_up > t.verdict.gap_after; }),
       0.95, no},
      {"13", "torque, toe and shoulder alone: the names hold the truth", share(trials, is_scalar, no_false_certainty),
       0.95, no},
      {"", "the ranking's first 95 % hold the truth",
       share(
           trials, [](const Judged& t) { return t.key.kind != Kind::kTurnLocked; }, in_credible_set),
       no, no},
      {"", "faults that turn with the drum: named exactly", share(trials, of_kind(Kind::kTurnLocked), is_right), no,
       no},
  };
  for (const Judged& t : trials) ++result.confusion[hidden(t)][said(t)];
  return result;
}

}  // namespace tumble::trials
