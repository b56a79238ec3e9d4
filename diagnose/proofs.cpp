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

bool is_guilty(const Accusation& a, std::size_t suspect) {
  const auto& guilty = a.explanation.suspects;
  return std::find(guilty.begin(), guilty.end(), static_cast<int>(suspect)) != guilty.end();
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
  Proof proof{accusation, {accusation.explanation.places, accusation.lifter}, std::vector<Replicas>(scenes), {}, {}};
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

Correction correction_by(const Proof& proof, const std::vector<Fitted>& fitted, const std::vector<Scene>& scenes,
                         const Correction& before) {
  Correction c;
  c.runs = INFINITY;  // the fewest of any condition
  const auto keys = static_cast<Eigen::Index>(scenes.front().middle.size());
  for (const Fitted& f : fitted) {
    const Scene& scene = scenes[f.scene];
    const auto& runs = proof.runs[f.scene];
    if (runs.seen.size() < kLeastRuns) return before;
    Eigen::VectorXd places = proof.model.places;
    for (std::size_t s = 0; s < scene.suspects.size(); ++s)
      if (!scene.suspects[s].is_simulated()) places[keys + static_cast<Eigen::Index>(s)] = 0;
    const auto expected = f.response->at(places);
    const double each = 1 / double(runs.seen.size());
    Eigen::VectorXd shift = -expected.mean;
    for (const auto& seen : runs.seen) shift += f.response->whitened(seen) * each;
    c.shift.push_back(std::move(shift));
    c.guess.push_back(expected.guess);
    Eigen::MatrixXd slopes(expected.slope.rows(), 0);
    for (const int place : proof.accusation.explanation.free) {
      if (place >= keys && !is_guilty(proof.accusation, static_cast<std::size_t>(place - keys))) continue;
      slopes.conservativeResize(Eigen::NoChange, slopes.cols() + 1);
      slopes.rightCols(1) = expected.slope.col(place);
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(slopes);
    c.directions.push_back(qr.householderQ() * Eigen::MatrixXd::Identity(slopes.rows(), slopes.cols()));
    c.runs = std::min(c.runs, double(runs.seen.size()));
  }
  if (before.runs > 0)
    for (std::size_t i = 0; i < c.shift.size(); ++i)
      c.shift[i] = (before.runs * before.shift[i] + c.runs * c.shift[i]) / (before.runs + c.runs);
  c.runs += before.runs;
  return c;
}

Case corrected(const Case& of, const Correction& correction) {
  Case again = of;
  if (correction.runs == 0) return again;
  const double by_chance = 1 / correction.runs;
  for (std::vector<Measured>& measured : again.by_lifter)
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const Eigen::MatrixXd& q = correction.directions[i];
      const Eigen::VectorXd along = q * (q.transpose() * correction.shift[i]), beside = correction.shift[i] - along;
      const double freedom = double(beside.size() - q.cols()),
                   off = std::max(correction.guess[i], beside.squaredNorm() / freedom - by_chance),
                   believed = off / (off + by_chance);
      measured[i].shift = along + believed * beside;
      measured[i].shift_variance = by_chance;
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
