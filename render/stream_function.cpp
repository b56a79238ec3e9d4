#include "render/stream_function.h"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace tumble::render {
namespace {

// phi v in cell (i, j) of the field with its rim; 0 where nothing moves or nothing is known.
double flow_in(const Field& field, const std::vector<double>& velocity, int i, int j) {
  if (i < 1 || j < 1 || i > field.n || j > field.n) return 0;
  const auto k = static_cast<std::size_t>(j - 1) * field.n + (i - 1);
  const double flow = field.occupancy[k] * velocity[k];
  return std::isnan(flow) ? 0 : flow;
}

}  // namespace

Grid stream_function(const Field& field, double shell_radius) {
  const int n = field.n + 2;  // a rim of cells that lie in the shell
  Grid psi{n, field.cell, std::vector<double>(static_cast<std::size_t>(n) * n, 0.0)};
  std::vector<int> unknown(psi.value.size(), -1);
  int count = 0;
  const auto index = [&](int i, int j) { return static_cast<std::size_t>(j) * n + i; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      if (std::hypot(psi.place(i), psi.place(j)) < shell_radius) unknown[index(i, j)] = count++;
  if (count == 0) return psi;

  // Between neighbours psi rises by the flow across the line that joins them: one equation for each such pair.
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  const auto join = [&](std::size_t a, std::size_t b, double rise) {
    const int p = unknown[a], q = unknown[b];
    if (p >= 0) {
      entries.emplace_back(p, p, 1);
      right[p] -= rise;
    }
    if (q >= 0) {
      entries.emplace_back(q, q, 1);
      right[q] += rise;
    }
    if (p >= 0 && q >= 0) {
      entries.emplace_back(p, q, -1);
      entries.emplace_back(q, p, -1);
    }
  };
  const double half = field.cell / 2;
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      join(index(i, j), index(i + 1, j), -half * (flow_in(field, field.vy, i, j) + flow_in(field, field.vy, i + 1, j)));
      join(index(i, j), index(i, j + 1), half * (flow_in(field, field.vx, i, j) + flow_in(field, field.vx, i, j + 1)));
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solved = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  for (std::size_t k = 0; k < unknown.size(); ++k)
    if (unknown[k] >= 0) psi.value[k] = solved[unknown[k]];
  return psi;
}

}  // namespace tumble::render
