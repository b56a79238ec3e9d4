#include "diagnose/proofs.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "diagnose/observe.h"

namespace tumble::diagnose {
namespace {

constexpr double kMostlyTold = 0.95;  // of the library's runs must tell a number
constexpr std::size_t kLeastRuns = 2;
constexpr int kMostRetreats = 4;
constexpr double kFar = 1;  // standard errors
// Over which a polynomial's error is much the same: of a key [standard deviations], of a strength [full strengths].
constexpr double kKeyReach = 1, kStrengthReach = 0.5;
// Variance of an error in the few directions in which keys and strengths could make up for it: what was simulated is
// believed there, for all that is found hangs on it.
constexpr double kOpen = 1;
constexpr double kUneven = 0.7, kScatterError = 0.15;  // ln of what chance does, against the usual, and as found

bool is_guilty(const Accusation& a, std::size_t suspect) {
  const auto& guilty = a.explanation.suspects;
  return std::find(guilty.begin(), guilty.end(), static_cast<int>(suspect)) != guilty.end();
}

// Without the observers' errors, which are computed and not simulated.
Eigen::VectorXd simulated_places(Eigen::VectorXd places, std::span<const Suspect> suspects) {
  const auto keys = places.size() - static_cast<Eigen::Index>(suspects.size());
  for (std::size_t s = 0; s < suspects.size(); ++s)
    if (!suspects[s].is_simulated()) places[keys + static_cast<Eigen::Index>(s)] = 0;
  return places;
}

double alike(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::Index keys) {
  const Eigen::VectorXd apart = a - b;
  return std::exp(-0.5 * (apart.head(keys).squaredNorm() / (kKeyReach * kKeyReach) +
                          apart.tail(apart.size() - keys).squaredNorm() / (kStrengthReach * kStrengthReach)));
}

struct Kriged {
  Eigen::VectorXd shift;
  double variance = 0;
};

// Simple kriging: errors of this variance, alike where they lie near, seen with what chance does to a few runs.
Kriged krige(const std::vector<FoundError>& found, const Eigen::VectorXd& at, Eigen::Index keys, double variance) {
  const auto n = static_cast<Eigen::Index>(found.size());
  Eigen::MatrixXd known(n, n), shifts(found.front().shift.size(), n);
  Eigen::VectorXd near(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FoundError& f = found[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j)
      known(i, j) = variance * alike(f.places, found[static_cast<std::size_t>(j)].places, keys);
    known(i, i) += f.scatter / f.runs;
    near[i] = variance * alike(f.places, at, keys);
    shifts.col(i) = f.shift;
  }
  const Eigen::VectorXd weights = known.ldlt().solve(near);
  return {shifts * weights, variance - near.dot(weights)};
}

// What chance does about there, against what it usually does.
double scatter_at(const std::vector<FoundError>& found, const Eigen::VectorXd& at, Eigen::Index keys) {
  std::vector<FoundError> logs;
  for (const FoundError& f : found) {
    const double known = 1 / (kScatterError * kScatterError);  // as a mean of so many
    logs.push_back({f.places, Eigen::VectorXd::Constant(1, std::log(f.scatter)), known, 1});
  }
  return std::exp(krige(logs, at, keys, kUneven * kUneven).shift[0]);
}

// Orthonormal: where the keys and the guilty move the numbers.
Eigen::MatrixXd ways_of(const Explanation& e, const Eigen::MatrixXd& slope, int keys) {
  Eigen::MatrixXd ways(slope.rows(), 0);
  for (const int place : e.free) {
    if (place >= keys && std::find(e.suspects.begin(), e.suspects.end(), place - keys) == e.suspects.end()) continue;
    ways.conservativeResize(Eigen::NoChange, ways.cols() + 1);
    ways.rightCols(1) = slope.col(place);
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(ways);
  return qr.householderQ() * Eigen::MatrixXd::Identity(ways.rows(), ways.cols());
}

}  // namespace

Fitted fit(const Condition& condition, const Scene& scene, std::size_t index, const std::set<Observable>& further) {
  const ObservationLayout layout(scene.measurement->config.mill.lifters.count);
  const Observation seen = observe(*scene.measurement, layout, scene.span);
  std::vector<const SignatureRun*> runs;
  for (const SignatureRun& run : condition.runs) runs.push_back(&run);
  std::vector<std::vector<double>> shown;
  for (const SignatureRun* run : runs) shown.push_back(observed_at(run->seen, scene.span));
  std::vector<std::size_t> chosen;
  std::vector<double> noise;
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const auto told = std::count_if(shown.begin(), shown.end(), [&](const auto& s) { return !std::isnan(s[i]); });
    const bool measured = !std::isnan(seen.value[i]) || further.contains(layout.observable_of(i));
    if (!measured || double(told) < kMostlyTold * double(shown.size())) continue;
    chosen.push_back(i);
    noise.push_back(seen.noise[i]);
  }
  if (chosen.empty())
    throw InputError(scene.measurement->experiment.place,
                     "brings nothing that simulations of it show too; give torque, toe and shoulder, or a film");
  Fitted f{
      index, std::make_unique<Response>(runs, condition.suspects, chosen, noise, scene.span, scene.torque_unit), {}};
  const bool turning = !std::isnan(seen.value[layout.first(Observable::kPockets)]);
  for (int l = 0; l < (turning ? layout.pockets : 1); ++l) f.by_lifter.push_back(turned_on(layout, seen.value, l));
  return f;
}

Case case_of(const std::vector<Fitted>& fitted, const std::vector<Scene>& scenes) {
  Case c;
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

Proof proof_of(const Accusation& accusation, std::size_t scenes, std::size_t keys) {
  Proof proof{accusation, {accusation.explanation.places, accusation.lifter}, std::vector<Replicas>(scenes)};
  // Observers that nobody accuses err by nothing that is worth correcting.
  auto& places = proof.model.places;
  for (std::size_t s = 0; s + keys < static_cast<std::size_t>(places.size()); ++s)
    if (!is_guilty(accusation, s)) places[static_cast<Eigen::Index>(keys + s)] = 0;
  return proof;
}

std::size_t simulate(Proof& proof, const Bench& bench, bool held_out, const Progress& progress) {
  std::vector<Scene> wanted;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < bench.scenes->size(); ++i) {
    const Scene& scene = (*bench.scenes)[i];
    if (scene.measurement->experiment.hold_out != held_out || !proof.runs[i].seen.empty()) continue;
    wanted.push_back(scene);
    which.push_back(i);
  }
  std::size_t simulated = 0;
  for (int retreat = 0; !wanted.empty(); ++retreat) {
    make_possible(proof.model, wanted, *bench.uncertain, *bench.mill_with);
    std::vector<Replicas> runs =
        resimulate(wanted, *bench.uncertain, proof.model, bench.seeds, *bench.mill_with, progress);
    simulated += wanted.size() * bench.seeds;
    bool enough = true;
    for (std::size_t i = 0; i < which.size(); ++i) {
      enough = enough && runs[i].seen.size() >= kLeastRuns;
      proof.runs[which[i]] = std::move(runs[i]);
    }
    if (enough || retreat == kMostRetreats) break;
    // Far from MILL.toml there may be no mill that holds together, of contacts too soft or balls that wedge.
    proof.model.places.head(static_cast<Eigen::Index>(bench.uncertain->size())) *= kRetreat;
  }
  return simulated;
}

void find_errors(FoundErrors& errors, const Proof& proof, const std::vector<Fitted>& fitted,
                 const std::vector<Scene>& scenes) {
  errors.resize(fitted.size());
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const Scene& scene = scenes[fitted[i].scene];
    const std::vector<std::vector<double>>& seen = proof.runs[fitted[i].scene].seen;
    if (seen.size() < kLeastRuns) continue;
    Eigen::VectorXd places = simulated_places(proof.model.places, scene.suspects);
    for (std::size_t s = 0; s < scene.suspects.size(); ++s)  // a drum holds whole balls
      if (double& strength = places[static_cast<Eigen::Index>(scene.middle.size() + s)]; strength != 0)
        strength = strength_of_sets(scene.suspects[s], strength);
    const Response& response = *fitted[i].response;
    const double runs = double(seen.size());
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(response.at(places).mean.size());
    double squares = 0;
    for (const auto& run : seen) mean += response.whitened(run) / runs;
    for (const auto& run : seen) squares += (response.whitened(run) - mean).squaredNorm();
    errors[i].push_back(
        {places, mean - response.at(places).mean, runs, squares / ((runs - 1) * double(response.numbers()))});
  }
}

Case corrected(const Case& of, const FoundErrors& errors, const Explanation& about) {
  Case again = of;
  for (std::size_t c = 0; c < errors.size(); ++c) {
    const std::vector<FoundError>& found = errors[c];
    if (found.empty()) continue;
    const Response& response = *of.by_lifter.front()[c].response;
    const auto expected = response.at(about.places);
    const Eigen::VectorXd places = simulated_places(about.places, of.suspects);
    const double numbers = double(response.numbers());
    double usual = 0;
    for (const FoundError& f : found)
      usual += (f.shift.squaredNorm() / numbers - f.scatter / f.runs) / double(found.size());
    usual = std::max(usual, expected.guess);
    const auto keys = static_cast<int>(response.uncertain());
    const Kriged beside = krige(found, places, keys, usual), along = krige(found, places, keys, std::max(usual, kOpen));
    const Eigen::MatrixXd q = ways_of(about, expected.slope, keys);
    const double ways = double(q.cols()) / numbers;
    const Eigen::VectorXd shift = beside.shift + q * (q.transpose() * (along.shift - beside.shift));
    const double scatter = scatter_at(found, places, keys);
    for (std::vector<Measured>& measured : again.by_lifter) {
      measured[c].scatter = scatter;
      measured[c].shift = shift;
      measured[c].shift_variance = (1 - ways) * beside.variance + ways * along.variance;
    }
  }
  return again;
}

bool has_moved(const Proof& proof, std::size_t keys) {
  const Explanation& e = proof.accusation.explanation;
  for (const int place : e.free) {
    const bool observer = place >= static_cast<int>(keys) && !is_guilty(proof.accusation, std::size_t(place) - keys);
    if (!observer && std::abs(e.places[place] - proof.model.places[place]) > kFar * e.se(place)) return true;
  }
  return false;
}

}  // namespace tumble::diagnose
