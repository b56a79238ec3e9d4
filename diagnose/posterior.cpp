#include "diagnose/posterior.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tumble::diagnose {
namespace {

// Before anything is seen. Each kind's share is divided among its members.
constexpr double kNone = 0.5, kSingles = 0.35, kPairs = 0.1, kUnknown = 0.05;
constexpr std::size_t kPairedWith = 6;  // likeliest singles, with each of which every other suspect is paired
// Chi2 per number that an unknown effect leaves behind, in units of what chance does: anything up to this.
constexpr double kMostMisfit = 30;
constexpr double kOneOfAHundred = 2.326;  // standard deviations of a normal distribution

double log_sum(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double l : logs) sum += std::exp(l - most);
  return most + std::log(sum);
}

bool turns(const Case& of, const std::vector<int>& guilty) {
  return std::any_of(guilty.begin(), guilty.end(),
                     [&](int s) { return of.suspects[static_cast<std::size_t>(s)].turns_with_drum; });
}

// Turning a drum on which all lifters are alike changes nothing, but the chance in one film it does: so who turns with
// the drum is compared with the same mill without him, the drum turned as far.
double evidence_at(const Case& of, std::size_t lifter, const Explanation& e) {
  if (lifter == 0) return e.log_evidence;
  Eigen::VectorXd without = e.places;
  const auto keys = without.size() - static_cast<Eigen::Index>(of.suspects.size());
  for (const int s : e.suspects)
    if (of.suspects[static_cast<std::size_t>(s)].turns_with_drum) without[keys + s] = 0;
  return e.log_evidence - log_likelihood(of.by_lifter[lifter], without) + log_likelihood(of.by_lifter[0], without);
}

// Somewhere on the drum: every lifter is as likely as the others.
Accusation accuse(const Case& of, const std::vector<int>& guilty, double log_prior) {
  Accusation best;
  std::vector<double> evidence;
  const std::size_t lifters = turns(of, guilty) ? of.by_lifter.size() : 1;
  double most = -INFINITY;
  for (std::size_t l = 0; l < lifters; ++l) {
    Explanation e = explain(of.by_lifter[l], of.suspects, guilty, of.clues);
    evidence.push_back(evidence_at(of, l, e));
    if (!(evidence.back() > most)) continue;
    most = evidence.back();
    best.explanation = std::move(e);
    best.lifter = static_cast<int>(l);
  }
  best.log_weight = log_sum(evidence) - std::log(double(lifters)) + log_prior;
  best.log_beside = best.log_weight - most;
  return best;
}

// ln of how much likelier an unknown effect makes this misfit than chance does: its logarithm is normal by chance, and
// anything up to kMostMisfit more by an unknown effect.
double unknown_ratio(double log_misfit, double sd) {
  const auto below = [&](double x) { return 0.5 * std::erfc(-(x - log_misfit) / sd / std::sqrt(2.0)); };
  const double by_chance = std::exp(-0.5 * log_misfit * log_misfit / (sd * sd)) / (sd * std::sqrt(2 * M_PI));
  const double otherwise = (below(std::log(kMostMisfit)) - below(0)) / std::log(kMostMisfit);
  return std::log(otherwise + 1e-300) - std::log(by_chance + 1e-300);
}

}  // namespace

Posterior weigh(const Case& of) {
  Posterior p;
  const int n = static_cast<int>(of.suspects.size());
  std::set<std::string> names;
  for (const Suspect& s : of.suspects) names.insert(s.name);
  const auto of_name = [&](int s) {
    return double(std::count_if(of.suspects.begin(), of.suspects.end(), [&](const Suspect& other) {
      return other.name == of.suspects[static_cast<std::size_t>(s)].name;
    }));
  };

  p.accusations.push_back(accuse(of, {}, std::log(kNone)));
  for (int s = 0; s < n; ++s)
    p.accusations.push_back(accuse(of, {s}, std::log(kSingles / double(names.size()) / of_name(s))));

  std::vector<std::size_t> order(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i + 1;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return p.accusations[a].log_weight > p.accusations[b].log_weight; });
  const double pairs = double(names.size() * (names.size() - 1)) / 2;
  std::set<std::pair<int, int>> done;
  for (std::size_t i = 0; i < std::min(kPairedWith, order.size()); ++i)
    for (int other = 0; other < n; ++other) {
      const int first = static_cast<int>(order[i]) - 1;
      const auto [a, b] = std::minmax(first, other);
      if (a == b || !done.insert({a, b}).second) continue;
      const Suspect &one = of.suspects[static_cast<std::size_t>(a)], &two = of.suspects[static_cast<std::size_t>(b)];
      if (one.name == two.name || (one.turns_with_drum && two.turns_with_drum)) continue;
      p.accusations.push_back(accuse(of, {a, b}, std::log(kPairs / pairs / of_name(a) / of_name(b))));
    }
  settle(p, of);
  return p;
}

Accusation weighed_again(const Accusation& accusation, const Case& of) {
  Accusation again = accusation;
  const auto lifter = static_cast<std::size_t>(accusation.lifter);
  again.explanation = explain(of.by_lifter[lifter], of.suspects, accusation.explanation.suspects, of.clues);
  again.log_weight = accusation.log_beside + evidence_at(of, lifter, again.explanation);
  return again;
}

void settle(Posterior& p, const Case& of) {
  std::stable_sort(p.accusations.begin(), p.accusations.end(),
                   [](const Accusation& a, const Accusation& b) { return a.log_weight > b.log_weight; });

  // The misfit of the likeliest against that of the library's own runs, taken as measurements.
  double variance = 0, weight = 0, log_misfit = 0;
  const std::vector<Measured>& measured = of.by_lifter.front();
  for (std::size_t c = 0; c < measured.size(); ++c) {
    const Response& r = *measured[c].response;
    const double numbers = double(r.numbers());
    // A run has a part in the scatter that it is judged by; a measurement has none.
    const double fresh = std::log(r.freedom() / (r.freedom() - numbers - 1));
    log_misfit +=
        numbers * (std::log(p.accusations.front().explanation.chi2_of[c] / numbers) - r.log_misfit().mean - fresh);
    variance += numbers * numbers * r.log_misfit().sd * r.log_misfit().sd;
    weight += numbers;
  }
  log_misfit /= weight;
  const double sd = std::sqrt(variance) / weight;
  p.misfit = std::exp(log_misfit);
  p.misfit_limit = std::exp(kOneOfAHundred * sd);

  std::vector<double> logs;
  for (const Accusation& a : p.accusations) logs.push_back(a.log_weight);
  const double known = log_sum(logs),
               unknown = known + std::log(kUnknown / (1 - kUnknown)) + unknown_ratio(log_misfit, sd);
  const double all = log_sum({known, unknown});
  for (Accusation& a : p.accusations) a.probability = std::exp(a.log_weight - all);
  p.unknown = std::exp(unknown - all);
}

double Posterior::none() const {
  for (const Accusation& a : accusations)
    if (a.explanation.suspects.empty()) return a.probability;
  return 0;
}

double Posterior::inclusion(std::span<const Suspect> suspects, const std::string& name) const {
  double sum = 0;
  for (const Accusation& a : accusations)
    for (const int s : a.explanation.suspects)
      if (suspects[static_cast<std::size_t>(s)].name == name) {
        sum += a.probability;
        break;
      }
  return sum;
}

}  // namespace tumble::diagnose
