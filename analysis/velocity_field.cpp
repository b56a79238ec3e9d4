#include "analysis/velocity_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "analysis/free_surface.h"
#include "core/statistics.h"

namespace tumble::analysis {
namespace {

constexpr int kSub = 4;                       // sample points per cell and direction
constexpr int kSamples = kFieldCells * kSub;  // and across the grid
constexpr std::size_t kCells = static_cast<std::size_t>(kFieldCells) * kFieldCells;
constexpr std::size_t kBatches = 16;
enum Column { kCovered, kMoving, kSumVx, kSumVy, kSumSquares, kColumns };

std::size_t at(Column c, std::size_t cell) { return static_cast<std::size_t>(c) * kCells + cell; }

// Least-squares plane v = a + b (x - x0) + c (y - y0), weighted by how much of a cell was covered and by nearness.
struct Plane {
  Eigen::Matrix<double, 3, 2> coefficients = Eigen::Matrix<double, 3, 2>::Zero();
  bool known = false;
};

Plane fit_plane(const std::vector<double>& sums, double cell, double x0, double y0, double reach) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  int used = 0;
  for (std::size_t k = 0; k < kCells; ++k) {
    const double w0 = sums[at(kMoving, k)];
    if (w0 <= 0) continue;
    const double dx = (static_cast<double>(k % kFieldCells) + 0.5 - kFieldCells / 2.0) * cell - x0;
    const double dy = (static_cast<double>(k / kFieldCells) + 0.5 - kFieldCells / 2.0) * cell - y0;
    const double d2 = (dx * dx + dy * dy) / (reach * reach);
    if (d2 >= 1) continue;
    const double w = w0 * (1 - d2) * (1 - d2);
    const Eigen::Vector3d basis(1, dx, dy);
    normal += w * basis * basis.transpose();
    right += w / w0 * basis * Eigen::RowVector2d(sums[at(kSumVx, k)], sums[at(kSumVy, k)]);
    ++used;
  }
  Plane plane;
  if (used < 6) return plane;
  plane.coefficients = normal.ldlt().solve(right);
  plane.known = plane.coefficients.allFinite();
  return plane;
}

double error_of_mean(const std::vector<double>& batches) {
  const double n = static_cast<double>(batches.size());
  if (n < 4) return kNotGiven;
  double mean = 0, squares = 0;
  for (const double b : batches) mean += b / n;
  for (const double b : batches) squares += (b - mean) * (b - mean);
  return std::sqrt(squares / (n * (n - 1)));
}

}  // namespace

FieldStatistics::FieldStatistics(double mill_radius)
    : radius_(mill_radius),
      cell_(2.0 * mill_radius / kFieldCells),
      sums_(kColumns * kCells, 64),
      row_(kColumns * kCells),
      owner_(static_cast<std::size_t>(kSamples) * kSamples) {}

void FieldStatistics::add(std::span<const MovingDisc> discs) {
  std::fill(owner_.begin(), owner_.end(), -1);
  std::fill(row_.begin(), row_.end(), 0.0);
  const double step = cell_ / kSub;
  const auto coordinate = [&](int i) { return (i + 0.5 - kSamples / 2.0) * step; };
  const auto index = [&](double x) { return static_cast<int>(std::floor(x / step + kSamples / 2.0)); };
  for (std::size_t b = 0; b < discs.size(); ++b) {
    const MovingDisc& d = discs[b];
    const int top = std::min(kSamples - 1, index(d.y + d.radius));
    for (int j = std::max(0, index(d.y - d.radius)); j <= top; ++j) {
      const double dy = coordinate(j) - d.y;
      const double half2 = d.radius * d.radius - dy * dy;
      if (half2 <= 0) continue;
      const double half = std::sqrt(half2);
      const int first = std::max(0, static_cast<int>(std::ceil((d.x - half) / step + kSamples / 2.0 - 0.5)));
      const int last = std::min(kSamples - 1, static_cast<int>(std::floor((d.x + half) / step + kSamples / 2.0 - 0.5)));
      for (int i = first; i <= last; ++i) owner_[static_cast<std::size_t>(j) * kSamples + i] = static_cast<int>(b);
    }
  }
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      const int b = owner_[static_cast<std::size_t>(j) * kSamples + i];
      if (b < 0) continue;
      const std::size_t cell = static_cast<std::size_t>(j / kSub) * kFieldCells + i / kSub;
      const MovingDisc& d = discs[static_cast<std::size_t>(b)];
      row_[at(kCovered, cell)] += 1.0 / (kSub * kSub);
      if (std::isnan(d.vx) || std::isnan(d.vy)) continue;
      row_[at(kMoving, cell)] += 1.0;
      row_[at(kSumVx, cell)] += d.vx;
      row_[at(kSumVy, cell)] += d.vy;
      row_[at(kSumSquares, cell)] += d.vx * d.vx + d.vy * d.vy;
    }
  }
  sums_.add(row_);
}

Field FieldStatistics::field() const {
  Field f;
  f.cell = cell_;
  f.n = kFieldCells;
  f.occupancy.assign(kCells, kNotGiven);
  f.occupancy_se = f.vx = f.vy = f.vx_se = f.vy_se = f.temperature = f.occupancy;
  if (sums_.rows() == 0) return f;
  const auto total = sums_.total();
  const auto batches = sums_.batches(kBatches);
  const double n = static_cast<double>(batches.size());
  const double frames = static_cast<double>(sums_.rows());
  for (std::size_t k = 0; k < kCells; ++k) {
    const double x = (static_cast<double>(k % kFieldCells) + 0.5 - kFieldCells / 2.0) * cell_;
    const double y = (static_cast<double>(k / kFieldCells) + 0.5 - kFieldCells / 2.0) * cell_;
    if (std::hypot(x, y) > radius_) continue;
    f.occupancy[k] = total[at(kCovered, k)] / frames;
    const double w = total[at(kMoving, k)];
    if (w > 0) {
      f.vx[k] = total[at(kSumVx, k)] / w;
      f.vy[k] = total[at(kSumVy, k)] / w;
      f.temperature[k] = 0.5 * std::max(0.0, total[at(kSumSquares, k)] / w - f.vx[k] * f.vx[k] - f.vy[k] * f.vy[k]);
    }
    if (batches.size() < 4) continue;
    double so = 0, sx = 0, sy = 0;  // squared departures of the batches, ratio estimator (Cochran 1977, section 6.3)
    for (const auto& b : batches) {
      const double o = b[at(kCovered, k)] - f.occupancy[k] * frames / n;
      so += o * o;
      if (w <= 0) continue;
      const double dx = b[at(kSumVx, k)] - f.vx[k] * b[at(kMoving, k)];
      const double dy = b[at(kSumVy, k)] - f.vy[k] * b[at(kMoving, k)];
      sx += dx * dx;
      sy += dy * dy;
    }
    const double spread = n / (n - 1);
    f.occupancy_se[k] = std::sqrt(so * spread) / frames;
    if (w <= 0) continue;
    f.vx_se[k] = std::sqrt(sx * spread) / w;
    f.vy_se[k] = std::sqrt(sy * spread) / w;
  }
  return f;
}

FieldStatistics::Centre FieldStatistics::centre_of_circulation(double reach) const {
  Centre best;
  const auto total = sums_.total();
  const double most = *std::max_element(total.begin(), total.begin() + kCells);
  if (!(most > 0)) return best;
  const auto share = [&](double x, double y) {
    const long i = std::lround(std::floor(x / cell_ + kFieldCells / 2.0));
    const long j = std::lround(std::floor(y / cell_ + kFieldCells / 2.0));
    if (i < 0 || j < 0 || i >= kFieldCells || j >= kFieldCells) return 0.0;
    return total[static_cast<std::size_t>(j) * kFieldCells + static_cast<std::size_t>(i)] / most;
  };
  double best_weight = 0;
  Eigen::Vector2d found(0, 0);
  Eigen::Matrix2d slope;
  for (std::size_t k = 0; k < kCells; ++k) {  // a start in every cell of the bulk: the basin of the right root is large
    Eigen::Vector2d c((static_cast<double>(k % kFieldCells) + 0.5 - kFieldCells / 2.0) * cell_,
                      (static_cast<double>(k / kFieldCells) + 0.5 - kFieldCells / 2.0) * cell_);
    if (k % 3 != 0 || share(c.x(), c.y()) < 0.5) continue;
    for (int step = 0; step < 30; ++step) {
      const Plane p = fit_plane(total, cell_, c.x(), c.y(), reach);
      if (!p.known) break;
      const Eigen::Matrix2d gradient = p.coefficients.bottomRows<2>().transpose();
      const double turn = gradient(1, 0) - gradient(0, 1);
      if (!(gradient.determinant() > 0) || !(turn > 0)) break;  // only a vortex that turns with the mill
      Eigen::Vector2d move = -gradient.inverse() * p.coefficients.row(0).transpose();
      const double far = move.norm();
      if (far > 0.5 * reach) move *= 0.5 * reach / far;
      c += move;
      if (share(c.x(), c.y()) < 0.5) break;
      if (far < 1e-4 * cell_) {
        const double weight = share(c.x(), c.y()) * turn;
        if (weight > best_weight * (1 + 1e-9)) {
          best_weight = weight;
          found = c;
          slope = gradient;
        }
        break;
      }
    }
  }
  if (best_weight == 0) return best;
  best.x.value = found.x();
  best.y.value = found.y();
  const auto batches = sums_.batches(kBatches);
  if (batches.size() < 4) return best;
  std::vector<double> along_x, along_y;  // a charge goes round many times slower than frames follow: batches are alike
  for (const auto& b : batches) {        // how far each batch would move the root, linearised
    const Plane p = fit_plane(b, cell_, found.x(), found.y(), reach);
    if (!p.known) continue;
    const Eigen::Vector2d d = -slope.inverse() * p.coefficients.row(0).transpose();
    along_x.push_back(d.x());
    along_y.push_back(d.y());
  }
  if (along_x.size() < 4) return best;
  best.x.se = mean_of_series(along_x).se;
  best.y.se = mean_of_series(along_y).se;
  return best;
}

std::vector<double> FieldStatistics::occupancy_of(std::span<const double> sums, double frames) const {
  std::vector<double> occupancy(sums.begin(), sums.begin() + kCells);  // kCovered comes first
  for (double& o : occupancy) o /= frames;
  return occupancy;
}

FieldStatistics::Surface FieldStatistics::surface() const {
  Surface surface;
  if (sums_.rows() == 0) return surface;
  const std::vector<double> mean = occupancy_of(sums_.total(), static_cast<double>(sums_.rows()));
  const double level = half_bulk(mean);
  const SurfaceLine line = free_surface(mean, kFieldCells, cell_, level);
  surface.angle_deg.value = surface_angle_deg(line.bed, line.across, line.height);
  const double c = std::cos(line.bed), s = std::sin(line.bed);
  for (std::size_t i = 0; i < line.across.size(); ++i)
    surface.line.push_back(
        {-c * line.height[i] - s * line.across[i], -s * line.height[i] + c * line.across[i], kNotGiven});
  const auto batches = sums_.batches(kBatches);
  if (batches.size() < 4) return surface;
  // The same points and direction in each batch; a batch in which a point has no charge says nothing of it.
  std::vector<std::vector<double>> heights(line.across.size());
  std::vector<double> angles;
  const double each = static_cast<double>(sums_.rows()) / static_cast<double>(batches.size());
  for (const auto& batch : batches) {
    const auto there = surface_heights(occupancy_of(batch, each), kFieldCells, cell_, level, line.bed, line.across);
    for (std::size_t i = 0; i < there.size(); ++i)
      if (!std::isnan(there[i])) heights[i].push_back(there[i]);
    const double angle = surface_angle_deg(line.bed, line.across, there);
    if (!std::isnan(angle)) angles.push_back(angle);
  }
  for (std::size_t i = 0; i < heights.size(); ++i) surface.line[i].se = error_of_mean(heights[i]);
  surface.angle_deg.se = error_of_mean(angles);
  return surface;
}

std::vector<bool> FieldStatistics::charge() const {
  std::vector<bool> charge(kCells, false);
  if (sums_.rows() == 0) return charge;
  const std::vector<double> mean = occupancy_of(sums_.total(), static_cast<double>(sums_.rows()));
  const double level = half_bulk(mean);
  for (std::size_t k = 0; k < kCells; ++k) charge[k] = mean[k] >= level;
  return charge;
}

std::size_t FieldStatistics::cell_at(double x, double y) const {
  const double i = std::floor(x / cell_ + 0.5 * kFieldCells), j = std::floor(y / cell_ + 0.5 * kFieldCells);
  if (!(i >= 0 && j >= 0 && i < kFieldCells && j < kFieldCells)) return kCells;
  return static_cast<std::size_t>(j) * kFieldCells + static_cast<std::size_t>(i);
}

Estimate FieldStatistics::granular_temperature() const {
  Estimate temperature;
  const std::vector<bool> charge = this->charge();
  const auto total = sums_.total();
  double weight = 0;
  const auto squares_of = [&](const std::vector<double>& sums, double& covered) {  // about the whole time's mean
    double squares = 0;
    covered = 0;
    for (std::size_t k = 0; k < kCells; ++k) {
      const double w = total[at(kMoving, k)];
      if (!charge[k] || w <= 0) continue;
      const double vx = total[at(kSumVx, k)] / w, vy = total[at(kSumVy, k)] / w;
      squares += sums[at(kSumSquares, k)] - 2 * (vx * sums[at(kSumVx, k)] + vy * sums[at(kSumVy, k)]) +
                 (vx * vx + vy * vy) * sums[at(kMoving, k)];
      covered += sums[at(kMoving, k)];
    }
    return 0.5 * squares;
  };
  const double all = squares_of(total, weight);
  if (!(weight > 0)) return temperature;
  temperature.value = std::max(0.0, all / weight);
  const auto batches = sums_.batches(kBatches);
  const double n = static_cast<double>(batches.size());
  if (batches.size() < 4) return temperature;
  double sum = 0;
  for (const auto& batch : batches) {  // ratio estimator, as in field()
    double covered = 0;
    const double squares = squares_of(batch, covered);
    const double d = squares - temperature.value * covered;
    sum += d * d;
  }
  temperature.se = std::sqrt(sum * n / (n - 1)) / weight;
  return temperature;
}

}  // namespace tumble::analysis
