#include "diagnose/next_experiment.h"

#include <Eigen/QR>
#include <algorithm>

#include "diagnose/rivals.h"

namespace tumble::diagnose {
namespace {

// Squared distance of two rivals' mills, less what the uncertain keys and the strengths could make of one of them, and
// less what chance does to the means.
double distance(const FurtherCondition& c, std::size_t a, std::size_t b, const Explanation& from) {
  const Eigen::VectorXd apart = c.seen[a] - c.seen[b];
  const auto expected = c.near->at(from.places);
  Eigen::MatrixXd moves(apart.size(), static_cast<Eigen::Index>(from.free.size()));
  for (std::size_t i = 0; i < from.free.size(); ++i)
    moves.col(static_cast<Eigen::Index>(i)) = expected.slope.col(from.free[i]);
  const Eigen::VectorXd left = apart - moves * moves.colPivHouseholderQr().solve(apart);
  const double by_chance = double(left.size() - moves.cols()) * 2 / c.replicas;
  return std::max(0.0, left.squaredNorm() - by_chance);
}

}  // namespace

std::vector<NextExperiment> next_experiments(const std::vector<Rival>& rivals, std::span<const Suspect> suspects,
                                             const std::vector<FurtherData>& data,
                                             const std::vector<FurtherCondition>& conditions) {
  std::vector<NextExperiment> list;
  double total = 0;
  for (const Rival& r : rivals) total += r.probability;
  const auto weigh_pairs = [&](NextExperiment next, const auto& gain) {
    double sum = 0, most = 0, pairs = 0;
    for (std::size_t a = 0; a < rivals.size(); ++a)
      for (std::size_t b = 0; b < rivals.size(); ++b) {
        if (a == b) continue;
        const double weight = rivals[a].probability * rivals[b].probability / (total * total), here = gain(a, b);
        pairs += weight;
        sum += weight * here;
        if (weight * here <= most) continue;
        most = weight * here;
        next.separates = {rivals[a].name, rivals[b].name};
      }
    next.expected_log_evidence = pairs > 0 ? sum / pairs : 0;
    list.push_back(std::move(next));
  };
  for (const FurtherData& d : data)
    weigh_pairs({{}, d.measure, {}, kNotGiven, d.cost}, [&](std::size_t a, std::size_t b) {
      return separation(d.measured, suspects, rivals[a].explanation.places, rivals[b].explanation.suspects);
    });
  for (const FurtherCondition& c : conditions)
    weigh_pairs({c.set, c.measure, {}, kNotGiven, c.cost},
                [&](std::size_t a, std::size_t b) { return 0.5 * distance(c, a, b, rivals[b].explanation); });
  std::stable_sort(list.begin(), list.end(), [](const NextExperiment& a, const NextExperiment& b) {
    return a.expected_log_evidence / a.cost > b.expected_log_evidence / b.cost;
  });
  return list;
}

}  // namespace tumble::diagnose
