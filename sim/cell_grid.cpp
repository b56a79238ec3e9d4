#include "sim/cell_grid.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace tumble::sim {

constexpr std::size_t kRoom = 8;  // for reading several at a time

int CellGrid::column(double x) const { return static_cast<int>((x - left_) * per_metre_); }
int CellGrid::row(double y) const { return static_cast<int>((y - bottom_) * per_metre_); }

void CellGrid::fill(const Charge& charge, double cell) {
  const auto size = static_cast<Eigen::Index>(charge.size());
  const Eigen::Map<const Eigen::ArrayXd> x(charge.x.data(), size), y(charge.y.data(), size);
  const double x_high = x.maxCoeff(), y_high = y.maxCoeff();
  left_ = x.minCoeff();
  bottom_ = y.minCoeff();
  // A few balls in a large mill must not cost a large grid.
  const double side = std::max(x_high - left_, y_high - bottom_);
  const double cells_across = 2 * std::sqrt(static_cast<double>(charge.size())) + 1;
  per_metre_ = 1 / std::max(cell, side / cells_across);
  columns_ = column(x_high) + 1;
  rows_ = row(y_high) + 1;

  const std::size_t n = charge.size();
  start_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
  cell_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    cell_[i] = row(charge.y[i]) * columns_ + column(charge.x[i]);
    ++start_[static_cast<std::size_t>(cell_[i]) + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  balls_.resize(n);
  for (auto* v : {&x_, &y_, &radius_}) v->resize(n + kRoom);
  for (std::size_t i = n; i-- > 0;) {  // from the back: start_ ends as each cell's end, then its beginning
    const auto p = static_cast<std::size_t>(--start_[static_cast<std::size_t>(cell_[i]) + 1]);
    balls_[p] = static_cast<int>(i);
    x_[p] = charge.x[i];
    y_[p] = charge.y[i];
    radius_[p] = charge.radius[i];
  }
  // Now start_[c + 1] is where cell c begins; shift back to start_[c].
  for (std::size_t c = 0; c + 1 < start_.size(); ++c) start_[c] = start_[c + 1];
  start_.back() = static_cast<int>(n);
}

void CellGrid::partners_of(const Charge& charge, int i, double skin, std::vector<int>& out) const {
  out.clear();
  const double x = charge.x[i], y = charge.y[i], r = charge.radius[i] + skin;
  // A ball that was moved since the cells were filled may have left them all (packing does that within a sweep).
  const int c = std::clamp(column(x), 0, columns_ - 1), w = std::clamp(row(y), 0, rows_ - 1);
  for (int v = std::max(0, w - 1); v <= std::min(rows_ - 1, w + 1); ++v) {
    // Neighbouring cells of a row lie side by side in balls_.
    const int from = start_[v * columns_ + std::max(0, c - 1)];
    const int to = start_[v * columns_ + std::min(columns_ - 1, c + 1) + 1];
    for (int k = from; k < to; ++k) {
      const int j = balls_[k];
      if (j <= i) continue;
      const double dx = charge.x[j] - x, dy = charge.y[j] - y, reach = r + charge.radius[j];
      if (dx * dx + dy * dy < reach * reach) out.push_back(j);
    }
  }
  std::sort(out.begin(), out.end());
}

}  // namespace tumble::sim
