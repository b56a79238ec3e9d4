#include "analysis/assignment.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace tumble::analysis {
namespace {

constexpr double kFar = 1e18;

// Hungarian method with potentials (Jonker & Volgenant 1987) on a small dense matrix, rows <= columns.
std::vector<int> solve_dense(const std::vector<std::vector<double>>& cost) {
  const std::size_t n = cost.size(), m = cost[0].size();
  std::vector<double> u(n + 1, 0), v(m + 1, 0);
  std::vector<std::size_t> row_of(m + 1, 0), way(m + 1, 0);
  for (std::size_t i = 1; i <= n; ++i) {
    row_of[0] = i;
    std::size_t j0 = 0;
    std::vector<double> least(m + 1, std::numeric_limits<double>::max());
    std::vector<char> used(m + 1, 0);
    do {
      used[j0] = 1;
      const std::size_t i0 = row_of[j0];
      double delta = std::numeric_limits<double>::max();
      std::size_t j1 = 0;
      for (std::size_t j = 1; j <= m; ++j) {
        if (used[j]) continue;
        const double reduced = cost[i0 - 1][j - 1] - u[i0] - v[j];
        if (reduced < least[j]) {
          least[j] = reduced;
          way[j] = j0;
        }
        if (least[j] < delta) {
          delta = least[j];
          j1 = j;
        }
      }
      for (std::size_t j = 0; j <= m; ++j) {
        if (used[j]) {
          u[row_of[j]] += delta;
          v[j] -= delta;
        } else {
          least[j] -= delta;
        }
      }
      j0 = j1;
    } while (row_of[j0] != 0);
    do {
      const std::size_t j1 = way[j0];
      row_of[j0] = row_of[j1];
      j0 = j1;
    } while (j0 != 0);
  }
  std::vector<int> column_of(n, -1);
  for (std::size_t j = 1; j <= m; ++j)
    if (row_of[j] > 0) column_of[row_of[j] - 1] = static_cast<int>(j - 1);
  return column_of;
}

}  // namespace

std::vector<std::pair<int, int>> assign(const std::vector<Pairing>& pairings, double alone) {
  // Pieces of the graph: union-find over rows (>= 0) and columns (as -1 - column).
  std::map<int, int> parent;
  const auto root = [&](int x) {
    while (parent[x] != x) x = parent[x] = parent[parent[x]];
    return x;
  };
  for (const Pairing& p : pairings) {
    for (int x : {p.row, -1 - p.column}) parent.emplace(x, x);
    parent[root(p.row)] = root(-1 - p.column);
  }
  std::map<int, std::vector<const Pairing*>> pieces;
  for (const Pairing& p : pairings) pieces[root(p.row)].push_back(&p);

  std::vector<std::pair<int, int>> chosen;
  for (const auto& [key, edges] : pieces) {
    if (edges.size() == 1) {
      if (edges[0]->cost < alone) chosen.emplace_back(edges[0]->row, edges[0]->column);
      continue;
    }
    std::vector<int> rows, columns;
    for (const Pairing* p : edges) {
      rows.push_back(p->row);
      columns.push_back(p->column);
    }
    for (auto* list : {&rows, &columns}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    const auto place = [](const std::vector<int>& list, int x) {
      return static_cast<std::size_t>(std::lower_bound(list.begin(), list.end(), x) - list.begin());
    };
    // Behind the real columns each row has one of its own: being left alone.
    std::vector<std::vector<double>> cost(rows.size(), std::vector<double>(columns.size() + rows.size(), kFar));
    for (std::size_t i = 0; i < rows.size(); ++i) cost[i][columns.size() + i] = alone;
    for (const Pairing* p : edges) cost[place(rows, p->row)][place(columns, p->column)] = p->cost;
    const auto column_of = solve_dense(cost);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto j = static_cast<std::size_t>(column_of[i]);
      if (j < columns.size() && cost[i][j] < alone) chosen.emplace_back(rows[i], columns[j]);
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace tumble::analysis
