#include "render/stream_function.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

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

// How far it is from a place inside the shell to the shell along a grid line, in cells; less than that is not resolved.
double cells_to_shell(double along, double across, double shell_radius, double cell) {
  const double reach = std::sqrt(std::max(0.0, shell_radius * shell_radius - across * across));
  return std::clamp((reach - std::abs(along)) / cell, 0.2, 1.0);
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

  // From a place to its neighbour psi rises by the flow across the line that joins them: one equation for each such
  // line. Where it meets the shell it ends there, at psi = 0.
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  const auto join = [&](int p, int q, double rise, double weight) {
    for (const auto& [own, other, sign] : {std::tuple(p, q, -1.0), std::tuple(q, p, 1.0)}) {
      if (own < 0) continue;
      entries.emplace_back(own, own, weight);
      if (other >= 0) entries.emplace_back(own, other, -weight);
      right[own] += sign * weight * rise;
    }
  };
  struct Rim {
    std::size_t inside, outside;
    double cells;  // from the place inside to the shell
  };
  std::vector<Rim> rim;
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      for (const bool upwards : {false, true}) {
        const int k = i + !upwards, l = j + upwards;
        const std::size_t a = index(i, j), b = index(k, l);
        const int p = unknown[a], q = unknown[b];
        const Flow here = flow_in(field, i, j), there = flow_in(field, k, l);
        const auto across = [&](const Flow& flow) { return (upwards ? flow.x : -flow.y) * field.cell; };
        if (p >= 0 && q >= 0) {
          join(p, q, (across(here) + across(there)) / 2, weight_of(here, there));
        } else if (p >= 0 || q >= 0) {
          const bool leaves = p >= 0;
          const double x = psi.place(leaves ? i : k), y = psi.place(leaves ? j : l);
          const double cells =
              upwards ? cells_to_shell(y, x, shell_radius, field.cell) : cells_to_shell(x, y, shell_radius, field.cell);
          const Flow& inside = leaves ? here : there;
          join(p, q, cells * across(inside), weight_of(inside, inside) / cells);
          rim.push_back({leaves ? a : b, leaves ? b : a, cells});
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solved = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  for (std::size_t k = 0; k < unknown.size(); ++k)
    if (unknown[k] >= 0) psi.value[k] = solved[unknown[k]];
  // Just outside, psi goes on as a straight line would through 0 at the shell: so lines between stay inside.
  std::vector<int> neighbours(psi.value.size(), 0);
  for (const Rim& r : rim) {
    const double beyond = psi.value[r.inside] * (1 - 1 / r.cells);
    psi.value[r.outside] += (beyond - psi.value[r.outside]) / ++neighbours[r.outside];
  }
  return psi;
}

}  // namespace tumble::render
