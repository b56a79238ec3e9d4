#include "diagnose/sampled.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/angle.h"
#include "core/quantile.h"

namespace tumble::diagnose {
namespace {

constexpr double kLeastCovered = 0.02;  // in the fuller of the two: below, a cell has seen a ball or two
constexpr double kLeastMoving = 0.05;   // in the emptier of the two: a mean velocity needs balls

using Grid = std::vector<double> Field::*;

bool whole(const Field& f) {
  const std::size_t cells = static_cast<std::size_t>(f.n) * static_cast<std::size_t>(f.n);
  return f.n > 0 && f.occupancy.size() == cells && f.occupancy_se.size() == cells && f.vx.size() == cells &&
         f.vy.size() == cells && f.vx_se.size() == cells && f.vy_se.size() == cells;
}

SampledDifference over_grid(const char* name, const char* unit, const Field& a, const Field& b, Grid value, Grid se) {
  SampledDifference d;
  d.name = name;
  d.unit = unit;
  d.n = a.n;
  d.cell = 2.0 / a.n;
  d.a = a.*value;
  d.b = b.*value;
  d.a_se = a.*se;
  d.b_se = b.*se;
  return d;
}

// In words, after the charge of the first: air, shell's ring, toe, shoulder, surface, bed.
std::string region_of(double x, double y, double occupancy, double bulk, const ChargeMotion& m, double bed_deg) {
  const double direction = degrees(std::atan2(y, x)), r = std::hypot(x, y);
  const auto near = [&](double deg) { return std::abs(wrap_180(direction - deg)) < 15; };
  if (r > 0.6 && near(m.toe_deg.value)) return "at the toe";
  if (r > 0.6 && near(m.shoulder_deg.value)) return "at the shoulder";
  if (occupancy >= 0.75 * bulk) return "in the bed";
  if (occupancy >= 0.25 * bulk)
    return std::abs(wrap_180(direction - bed_deg)) < 60 && r > 0.75 ? "at the shell" : "at the surface";
  return "in the air";
}

std::string most_of(const SampledDifference& d, const ChargeMotion& a, const ChargeMotion& b) {
  std::vector<double> covered;
  for (const double o : a.field.occupancy)
    if (o > kLeastCovered) covered.push_back(o);
  if (covered.empty()) return "";
  const double bulk = quantile_of(std::move(covered), 0.9), bed = common_bed_deg(a, b);
  std::map<std::string, int> count;
  for (std::size_t k = 0; k < d.z.size(); ++k) {
    if (!d.significant[k]) continue;
    const double x = (static_cast<double>(k % static_cast<std::size_t>(d.n)) + 0.5) * d.cell - 1;
    const double y = (static_cast<double>(k / static_cast<std::size_t>(d.n)) + 0.5) * d.cell - 1;
    ++count[region_of(x, y, a.field.occupancy[k], bulk, a, bed)];
  }
  std::string where;
  int most = 0;
  for (const auto& [region, n] : count)
    if (n > most) most = n, where = region;
  return where;
}

struct Direction {
  double c = 0, s = 0;  // from the axis to the bed's middle
};

// Places of the surface across and above the bed, in a common direction.
struct Above {
  double across = 0, height = 0, se = kNotGiven;
};
std::vector<Above> across_bed(const std::vector<SurfacePoint>& surface, Direction bed) {
  std::vector<Above> line;
  for (const SurfacePoint& p : surface) line.push_back({-bed.s * p.x + bed.c * p.y, -bed.c * p.x - bed.s * p.y, p.se});
  std::sort(line.begin(), line.end(), [](const Above& p, const Above& q) { return p.across < q.across; });
  return line;
}

Estimate height_at(const std::vector<Above>& line, double across) {
  const auto after =
      std::lower_bound(line.begin(), line.end(), across, [](const Above& p, double at) { return p.across < at; });
  if (after == line.end() || after == line.begin()) return {};
  const Above &p = *(after - 1), &q = *after;
  const double w = (across - p.across) / (q.across - p.across);
  // Neighbours move together: their errors are blended as they are.
  return {(1 - w) * p.height + w * q.height, (1 - w) * p.se + w * q.se};
}

void add(SampledDifference& d, double x, const Estimate& a, const Estimate& b) {
  d.x.push_back(x);
  d.a.push_back(a.value);
  d.a_se.push_back(a.se);
  d.b.push_back(b.value);
  d.b_se.push_back(b.se);
}

SampledDifference surface_line(const ChargeMotion& a, const ChargeMotion& b, Direction bed) {
  SampledDifference d{.name = "surface", .unit = "m", .x_name = "across the bed, towards the shoulder", .x_unit = "m"};
  const auto la = across_bed(a.surface, bed), lb = across_bed(b.surface, bed);
  const double step = a.field.cell;
  if (la.size() < 2 || lb.size() < 2 || !(step > 0)) return d;
  const double from = std::min(la.front().across, lb.front().across);
  const double to = std::max(la.back().across, lb.back().across);
  for (double x = step * std::ceil(from / step); x <= to; x += step) add(d, x, height_at(la, x), height_at(lb, x));
  return d;
}

// Velocity along the surface, towards the shoulder, in the cell at a place of the bed's middle line.
Estimate along_surface(const ChargeMotion& m, double height, Direction bed) {
  const Field& f = m.field;
  const double x = -bed.c * height, y = -bed.s * height;
  const int i = static_cast<int>(std::floor(x / f.cell + 0.5 * f.n)),
            j = static_cast<int>(std::floor(y / f.cell + 0.5 * f.n));
  if (i < 0 || j < 0 || i >= f.n || j >= f.n) return {};
  const std::size_t k = static_cast<std::size_t>(j) * static_cast<std::size_t>(f.n) + static_cast<std::size_t>(i);
  if (!(f.occupancy[k] >= kLeastMoving)) return {};
  return {-bed.s * f.vx[k] + bed.c * f.vy[k], std::hypot(bed.s * f.vx_se[k], bed.c * f.vy_se[k])};
}

SampledDifference velocity_line(const ChargeMotion& a, const ChargeMotion& b, Direction bed) {
  SampledDifference d{.name = "velocity_through_bed",
                      .unit = "m/s",
                      .x_name = "height above the axis, square to the bed",
                      .x_unit = "m"};
  const double step = a.field.cell, reach = 0.5 * a.field.n * step;
  for (double h = -reach + 0.5 * step; h < reach; h += step) {
    const Estimate va = along_surface(a, h, bed), vb = along_surface(b, h * b.field.cell / a.field.cell, bed);
    if (!std::isnan(va.value) || !std::isnan(vb.value)) add(d, h, va, vb);
  }
  return d;
}

SampledDifference ring_line(const ChargeMotion& a, const ChargeMotion& b) {
  SampledDifference d{.name = "ring_occupancy", .unit = "", .x_name = "angle", .x_unit = "deg"};
  for (std::size_t i = 0; i < a.ring_occupancy.size(); ++i)
    add(d, static_cast<double>(i) + 0.5, {a.ring_occupancy[i], a.ring_occupancy_se[i]},
        {b.ring_occupancy[i], b.ring_occupancy_se[i]});
  return d;
}

bool any(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v) && v != 0; });
}

}  // namespace

void judge(SampledDifference& d, const Freedoms& freedoms, bool ratio) {
  const std::size_t n = d.a.size();
  d.difference.assign(n, kNotGiven);
  d.se = d.z = d.difference;
  std::vector<double> chances(n, kNotGiven);
  double squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    d.difference[i] = d.b[i] - d.a[i];
    d.se[i] = std::hypot(d.a_se[i], d.b_se[i]);
    double se_a = d.a_se[i], se_b = d.b_se[i], apart = d.difference[i];
    if (ratio) {
      apart = std::log(d.b[i] / d.a[i]);
      se_a /= d.a[i];
      se_b /= d.b[i];
    }
    const double se = std::hypot(se_a, se_b);
    if (!(se > 0) || !std::isfinite(apart)) continue;
    d.z[i] = apart / se;
    const double normal = normal_z(d.z[i], welch_freedom(se_a, se_b, freedoms));
    chances[i] = two_sided_chance(normal);
    squares += normal * normal;
  }
  d.significant = beyond_chance(chances, kFalseAlarms);
  d.compared = static_cast<int>(std::count_if(chances.begin(), chances.end(), [](double p) { return !std::isnan(p); }));
  if (d.compared > 0) d.mean_square = squares / d.compared;
  d.beyond_chance = static_cast<int>(std::count(d.significant.begin(), d.significant.end(), 1));
}

double common_bed_deg(const ChargeMotion& a, const ChargeMotion& b) {
  double x = 0, y = 0;
  for (const ChargeMotion* m : {&a, &b}) {
    const Field& f = m->field;
    double mx = 0, my = 0, sum = 0;
    for (std::size_t k = 0; k < f.occupancy.size(); ++k) {
      if (!(f.occupancy[k] > kLeastCovered)) continue;
      mx += f.occupancy[k] * (static_cast<double>(k % static_cast<std::size_t>(f.n)) + 0.5 - 0.5 * f.n);
      my += f.occupancy[k] * (static_cast<double>(k / static_cast<std::size_t>(f.n)) + 0.5 - 0.5 * f.n);
      sum += f.occupancy[k];
    }
    if (sum > 0) x += mx / sum, y += my / sum;
  }
  return x == 0 && y == 0 ? kNotGiven : degrees(std::atan2(y, x));
}

std::vector<SampledDifference> compare_fields(const ChargeMotion& a, const ChargeMotion& b, bool velocities) {
  const Field &fa = a.field, &fb = b.field;
  if (!whole(fa) || !whole(fb) || fa.n != fb.n) return {};
  SampledDifference covered = over_grid("occupancy", "", fa, fb, &Field::occupancy, &Field::occupancy_se);
  SampledDifference vx = over_grid("velocity_x", "m/s", fa, fb, &Field::vx, &Field::vx_se);
  SampledDifference vy = over_grid("velocity_y", "m/s", fa, fb, &Field::vy, &Field::vy_se);
  for (std::size_t k = 0; k < covered.a.size(); ++k) {
    if (!(std::max(covered.a[k], covered.b[k]) >= kLeastCovered)) covered.a_se[k] = kNotGiven;
    if (!(std::min(covered.a[k], covered.b[k]) >= kLeastMoving)) vx.a_se[k] = vy.a_se[k] = kNotGiven;
  }
  std::vector<SampledDifference> all{std::move(covered)};
  if (velocities && any(vx.a) && any(vx.b)) {
    all.push_back(std::move(vx));
    all.push_back(std::move(vy));
  }
  const Freedoms freedoms{batch_freedom(a.frames), batch_freedom(b.frames)};
  for (SampledDifference& d : all) {
    judge(d, freedoms);
    d.where = most_of(d, a, b);
  }
  return all;
}

std::vector<SampledDifference> compare_lines(const ChargeMotion& a, const ChargeMotion& b, bool lengths) {
  std::vector<SampledDifference> all;
  if (any({a.ring_occupancy.begin(), a.ring_occupancy.end()}) &&
      any({b.ring_occupancy.begin(), b.ring_occupancy.end()}))
    all.push_back(ring_line(a, b));
  const double bed = common_bed_deg(a, b);
  if (lengths && !std::isnan(bed) && whole(a.field) && whole(b.field) && a.field.n == b.field.n) {
    const Direction direction{std::cos(radians(bed)), std::sin(radians(bed))};
    all.push_back(surface_line(a, b, direction));
    all.push_back(velocity_line(a, b, direction));
  }
  std::erase_if(all, [](const SampledDifference& d) { return d.a.empty(); });
  const Freedoms freedoms{batch_freedom(a.frames), batch_freedom(b.frames)};
  for (SampledDifference& d : all) judge(d, freedoms);
  return all;
}

}  // namespace tumble::diagnose
