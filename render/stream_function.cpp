#include "render/stream_function.h"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace tumble::render {
namespace {

// The field in cell (i, j), counted with a rim of cells that lie in the shell.
struct Flow {
  double covered = 0, x = 0, y = 0;  // phi, phi v [m/s]; 0 where nothing moves or nothing is known
};
Flow flow_in(const Field& field, int i, int j) {
  if (i < 1 || j < 1 || i > field.n || j > field.n) return {};
  const auto k = static_cast<std::size_t>(j - 1) * field.n + (i - 1);
  const double phi = field.occupancy[k], x = phi * field.vx[k], y = phi * field.vy[k];
  return std::isnan(x + y) ? Flow{} : Flow{phi, x, y};
}

// A flow is known to a share of what is there: where hardly anything is, nothing streams.
double weight_of(const Flow& a, const Flow& b) {
  constexpr double kFloor = 0.02;
  return 1 / std::pow((a.covered + b.covered) / 2 + kFloor, 2);
}

}  // namespace

Grid stream_function(const Field& field, double shell_radius) {
  const int n = field.n + 2;
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
  const auto join = [&](std::size_t a, std::size_t b, double rise, double weight) {
    const int p = unknown[a], q = unknown[b];
    if (p >= 0) {
      entries.emplace_back(p, p, weight);
      right[p] -= weight * rise;
    }
    if (q >= 0) {
      entries.emplace_back(q, q, weight);
      right[q] += weight * rise;
    }
    if (p >= 0 && q >= 0) {
      entries.emplace_back(p, q, -weight);
      entries.emplace_back(q, p, -weight);
    }
  };
  const double half = field.cell / 2;
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const Flow here = flow_in(field, i, j), right_of = flow_in(field, i + 1, j), above = flow_in(field, i, j + 1);
      join(index(i, j), index(i + 1, j), -half * (here.y + right_of.y), weight_of(here, right_of));
      join(index(i, j), index(i, j + 1), half * (here.x + above.x), weight_of(here, above));
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
