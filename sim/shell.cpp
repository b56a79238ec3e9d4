#include "sim/shell.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "sim/kernels/kernels.h"

namespace tumble::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFacesInBlock = 8;  // of longer runs

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Circle {
  double x = 0, y = 0, reach = 0;
};

// Around the middle of their box, which is good enough.
template <class Points>
Circle around(const Points& points) {
  Vec2 low(kInfinity, kInfinity), high(-kInfinity, -kInfinity);
  for (const Vec2& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Circle c{(low.x() + high.x()) / 2, (low.y() + high.y()) / 2, 0};
  for (const Vec2& p : points) c.reach = std::max(c.reach, std::hypot(p.x() - c.x, p.y() - c.y));
  return c;
}

// Corners where a run of the outline begins and ends: its ends, and where re-entrant corners add up to a real one.
std::vector<std::size_t> cuts_of(const std::vector<Vec2>& p, bool smooth) {
  std::vector<std::size_t> cuts{0};
  double hollow = 0;
  for (std::size_t i = 1; i + 1 < p.size() && !smooth; ++i) {
    const Vec2 in = p[i] - p[i - 1], out = p[i + 1] - p[i];
    hollow += std::max(0.0, -std::atan2(cross(in, out), in.dot(out)));
    if (hollow <= kSeam) continue;
    cuts.push_back(i);
    hollow = 0;
  }
  cuts.push_back(p.size() - 1);
  return cuts;
}

// Do the points in a row, closed, go once round a convex body, counter-clockwise?
bool closes_convex(const std::vector<Vec2>& p) {
  double turned = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 in = p[(i + 1) % p.size()] - p[i], out = p[(i + 2) % p.size()] - p[(i + 1) % p.size()];
    const double turn = std::atan2(cross(in, out), in.dot(out));
    if (turn < 0) return false;
    turned += turn;
  }
  return turned < 3 * kPi;
}

void add_run(Shell& shell, const MillShape& shape, int section_number, const std::vector<Vec2>& p) {
  const LifterSection& section = shape.sections[static_cast<std::size_t>(section_number)];
  Run run;
  run.section = section_number;
  run.begin = static_cast<int>(shell.faces.size());
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const Vec2 a = p[i], b = p[i + 1];
    const Vec2 t = (b - a).normalized();
    const Vec2 n(t.y(), -t.x());
    FaceCorners corners{n.x(), n.y(), n.x(), n.y()};
    FaceLabels labels;
    labels.face = labels.at_start = labels.at_end = face_of(section, shape.radius, (a + b) / 2, n);
    if (i > 0) {
      FaceCorners& before = shell.corners.back();
      const Vec2 corner = n + Vec2(before.ex, before.ey);  // so far the normal of the face before
      before.ex = corners.sx = corner.x();
      before.ey = corners.sy = corner.y();
      shell.labels.back().at_end = labels.at_start = face_of(section, shape.radius, a, corner);
    }
    shell.faces.push_back(
        {a.x(), a.y(), t.x(), t.y(), n.x(), n.y(), (b - a).norm(), static_cast<double>(shell.faces.size())});
    shell.corners.push_back(corners);
    shell.labels.push_back(labels);
  }
  run.end = static_cast<int>(shell.faces.size());
  // Only where the closing line lies in the shell's steel: a ball under a hook would take it for a face.
  run.convex = p.size() == section.chain.size() && closes_convex(p);
  run.first_block = static_cast<int>(shell.blocks.size());
  for (std::size_t i = 0; i + 1 < p.size(); i += kFacesInBlock) {
    const std::size_t end = std::min(i + kFacesInBlock, p.size() - 1);
    const Circle c = around(std::vector<Vec2>(p.begin() + static_cast<std::ptrdiff_t>(i),
                                              p.begin() + static_cast<std::ptrdiff_t>(end) + 1));
    shell.blocks.push_back({run.begin + static_cast<int>(i), run.begin + static_cast<int>(end), c.x, c.y, c.reach});
  }
  run.last_block = static_cast<int>(shell.blocks.size());
  const Circle c = around(p);
  run.x = c.x;
  run.y = c.y;
  run.reach = c.reach;
  shell.runs.push_back(run);
}

struct Nearest {
  double distance = 0;
  double nx = 0, ny = 0;
  Face face = Face::kTop;
};

// Out of sight: no ball is as large, and what is worked out from it stays finite.
Nearest hidden(const Shell& shell) { return {2 * shell.radius, 1, 0, Face::kTop}; }

struct Closest {
  int face = 0;
  Foot<double> foot{0, 0, 0, kInfinity};
};

void look_through(const Shell& shell, const FaceBlock& block, double x, double y, Closest& best) {
  for (int i = block.begin; i < block.end; ++i) {
    const Foot<double> foot = foot_on(shell.faces[static_cast<std::size_t>(i)], x, y);
    // Of two as near, the first: so it does not matter which block is looked at first.
    if (foot.d2 < best.foot.d2 || (foot.d2 == best.foot.d2 && i < best.face)) best = {i, foot};
  }
}

// The nearest block first: it rules out most of the others.
Closest closest_of(const Shell& shell, const Run& run, double x, double y) {
  const auto square = [&](const FaceBlock& b) { return (x - b.x) * (x - b.x) + (y - b.y) * (y - b.y); };
  int first = run.first_block;
  double nearest = kInfinity;
  for (int b = run.first_block; b < run.last_block; ++b) {
    const double d2 = square(shell.blocks[static_cast<std::size_t>(b)]);
    if (!(d2 < nearest)) continue;
    nearest = d2;
    first = b;
  }
  Closest best;
  look_through(shell, shell.blocks[static_cast<std::size_t>(first)], x, y, best);
  double within = std::sqrt(best.foot.d2);
  for (int b = run.first_block; b < run.last_block; ++b) {
    const FaceBlock& block = shell.blocks[static_cast<std::size_t>(b)];
    const double far = within + block.reach;
    if (b == first || square(block) > 1.000001 * far * far) continue;
    look_through(shell, block, x, y, best);
    within = std::sqrt(best.foot.d2);
  }
  return best;
}

// The point as the wall's nearest; `side` is 1 for a centre outside, -1 for one in the steel.
Nearest point_of(const Shell& shell, const Closest& c, double x, double y, double side) {
  const LifterFace& f = shell.faces[static_cast<std::size_t>(c.face)];
  const FaceCorners& ends = shell.corners[static_cast<std::size_t>(c.face)];
  const FaceLabels& labels = shell.labels[static_cast<std::size_t>(c.face)];
  if (c.foot.along > 0 && c.foot.along < f.length) return {out_of(f, x, y), -f.nx, -f.ny, labels.face};
  const bool start = c.foot.along <= 0;
  const Face face = start ? labels.at_start : labels.at_end;
  const double d = std::sqrt(c.foot.d2), per_d = 1 / d;
  if (d > 0) return {side * d, side * c.foot.dx * per_d, side * c.foot.dy * per_d, face};
  const double ox = start ? ends.sx : ends.ex, oy = start ? ends.sy : ends.ey, o = std::hypot(ox, oy);
  return {0, -ox / o, -oy / o, face};
}

// Is the point on the free side of the outline at the point of it that is closest?
bool in_front(const Shell& shell, const Closest& c, double x, double y) {
  const LifterFace& f = shell.faces[static_cast<std::size_t>(c.face)];
  const FaceCorners& ends = shell.corners[static_cast<std::size_t>(c.face)];
  if (c.foot.along <= 0) return c.foot.dx * ends.sx + c.foot.dy * ends.sy <= 0;
  if (c.foot.along >= f.length) return c.foot.dx * ends.ex + c.foot.dy * ends.ey <= 0;
  return out_of(f, x, y) >= 0;
}

// Is the point in the steel of a section? The axis is not, and each crossing of the outline on the way to it tells.
bool in_steel(const Shell& shell, int section, double x, double y) {
  bool inside = false;
  for (const Run& run : shell.runs) {
    if (run.section != section) continue;
    for (int i = run.begin; i < run.end; ++i) {
      const LifterFace& f = shell.faces[static_cast<std::size_t>(i)];
      const double ax = f.x, ay = f.y, bx = ax + f.length * f.tx, by = ay + f.length * f.ty;
      // Its ends lie on either side of the ray from the axis through the point, and it crosses short of the point.
      const double a = x * ay - y * ax, b = x * by - y * bx;
      if ((a > 0) == (b > 0)) continue;
      const double s = a / (a - b), px = ax + s * (bx - ax), py = ay + s * (by - ay);
      const double along = px * x + py * y;
      if (along > 0 && along < x * x + y * y) inside = !inside;
    }
  }
  return inside;
}

// A centre behind the run: in the steel and nearest to this run, or out of its sight.
Nearest from_behind(const Shell& shell, const Run& run, double x, double y) {
  if (!in_steel(shell, run.section, x, y)) return hidden(shell);
  const Closest mine = closest_of(shell, run, x, y);
  for (const Run& other : shell.runs) {
    if (other.section != run.section || &other == &run) continue;
    const double d2 = closest_of(shell, other, x, y).foot.d2;
    if (d2 < mine.foot.d2 || (d2 == mine.foot.d2 && &other < &run)) return hidden(shell);
  }
  return point_of(shell, mine, x, y, -1);
}

Nearest nearest_on_run(const Shell& shell, const Run& run, double x, double y) {
  if (!run.convex) {
    const Closest c = closest_of(shell, run, x, y);
    return in_front(shell, c, x, y) ? point_of(shell, c, x, y, 1) : from_behind(shell, run, x, y);
  }
  // The face from which the point stands out farthest holds the nearest point of a convex body, or one of its ends.
  int farthest = run.begin;
  double out = -kInfinity;
  for (int i = run.begin; i < run.end; ++i) {
    const double d = out_of(shell.faces[static_cast<std::size_t>(i)], x, y);
    if (d > out) {
      out = d;
      farthest = i;
    }
  }
  if (out <= 0) return from_behind(shell, run, x, y);
  return point_of(shell, {farthest, foot_on(shell.faces[static_cast<std::size_t>(farthest)], x, y)}, x, y, 1);
}

}  // namespace

Shell make_shell(const MillShape& shape) {
  Shell shell;
  shell.radius = shape.radius;
  shell.tip_radius = shape.sections.empty() ? shape.radius : shape.tip_radius;
  if (shape.sections.empty()) return shell;
  shell.lifter_count = shape.lifter_count;
  shell.plate_covered = true;

  std::vector<std::size_t> first_run{0};  // of each section
  double low = shape.radius, high = 0;
  for (std::size_t s = 0; s < shape.sections.size(); ++s) {
    const LifterSection& section = shape.sections[s];
    shell.plate_covered = shell.plate_covered && section.smooth;
    const std::vector<Vec2> chain(section.chain.rbegin(), section.chain.rend());
    const std::vector<std::size_t> cuts = cuts_of(chain, section.smooth);
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c)
      add_run(shell, shape, static_cast<int>(s),
              std::vector<Vec2>(chain.begin() + static_cast<std::ptrdiff_t>(cuts[c]),
                                chain.begin() + static_cast<std::ptrdiff_t>(cuts[c + 1]) + 1));
    first_run.push_back(shell.runs.size());
    for (const Vec2& p : chain) {
      low = std::min(low, p.x());
      high = std::max(high, p.x());
    }
  }
  shell.lifter_centre = (low + high) / 2;
  for (const LifterSection& section : shape.sections)
    for (const Vec2& p : section.chain)
      shell.lifter_reach = std::max(shell.lifter_reach, std::hypot(p.x() - shell.lifter_centre, p.y()));

  shell.run_of.push_back(-1);
  for (int k = 0; k < shell.lifter_count; ++k) {
    shell.first_feature.push_back(static_cast<int>(shell.features.size()) + 1);
    const int section = shape.section_of[static_cast<std::size_t>(k)];
    if (section < 0) {
      shell.plate_covered = false;
      continue;
    }
    for (std::size_t r = first_run[static_cast<std::size_t>(section)];
         r < first_run[static_cast<std::size_t>(section) + 1]; ++r) {
      const Run& run = shell.runs[r];
      shell.features.push_back(
          {std::cos(k * shape.pitch()), std::sin(k * shape.pitch()), run.x, run.y, run.reach, static_cast<int>(r), k});
      shell.run_of.push_back(static_cast<double>(r));
    }
  }
  shell.first_feature.push_back(static_cast<int>(shell.features.size()) + 1);
  return shell;
}

ConvexLifters convex_lifters(const Shell& shell) {
  ConvexLifters lifters;
  if (shell.runs.size() != 1 || !shell.runs[0].convex) return lifters;
  const Run& run = shell.runs[0];
  if (run.end - run.begin > kMostFaces) return lifters;
  for (int i = run.begin; i < run.end; ++i) {
    const LifterFace& f = shell.faces[static_cast<std::size_t>(i)];
    const int k = lifters.faces++;
    lifters.x[k] = f.x;
    lifters.y[k] = f.y;
    lifters.tx[k] = f.tx;
    lifters.ty[k] = f.ty;
    lifters.nx[k] = f.nx;
    lifters.ny[k] = f.ny;
    lifters.length[k] = f.length;
  }
  return lifters;
}

LifterRuns lifter_runs(const Shell& shell) {
  LifterRuns runs;
  runs.faces = shell.faces.data();
  runs.corners = shell.corners.data();
  runs.blocks = shell.blocks.data();
  runs.runs = shell.runs.data();
  runs.count = static_cast<int>(shell.runs.size());
  runs.run_of = shell.run_of.data();
  runs.out_of_sight = 2 * shell.radius;
  return runs;
}

ShellPose pose_of(double mill_angle) { return {std::cos(mill_angle), std::sin(mill_angle)}; }

WallPoint nearest_on_wall(const Shell& shell, const ShellPose& pose, int feature, double x, double y) {
  if (feature == 0) {
    const double rho = std::sqrt(x * x + y * y), per_rho = 1 / rho;
    return {shell.plate_covered ? 2 * shell.radius : shell.radius - rho, x * per_rho, y * per_rho, Face::kPlate};
  }
  const Feature& f = shell.features[static_cast<std::size_t>(feature) - 1];
  const Direction l = direction_of(f, pose);
  const Nearest near =
      nearest_on_run(shell, shell.runs[static_cast<std::size_t>(f.run)], x * l.cos + y * l.sin, y * l.cos - x * l.sin);
  return {near.distance, near.nx * l.cos - near.ny * l.sin, near.nx * l.sin + near.ny * l.cos, near.face};
}

void features_near(const Shell& shell, const ShellPose& pose, double x, double y, double reach,
                   std::vector<NearFeature>& out) {
  const double rho = std::sqrt(x * x + y * y);
  if (rho + reach <= shell.tip_radius) return;
  if (rho + reach > shell.radius && !shell.plate_covered) out.push_back({0, shell.radius - rho});
  if (shell.features.empty()) return;

  const auto first = static_cast<std::ptrdiff_t>(out.size());
  // Whether the point is in front is not asked: on its way to where the list is next renewed it may come round a tip.
  const auto add_if_near = [&](int k) {
    for (int feature = shell.first_feature[static_cast<std::size_t>(k)];
         feature < shell.first_feature[static_cast<std::size_t>(k) + 1]; ++feature) {
      const Feature& f = shell.features[static_cast<std::size_t>(feature) - 1];
      const Direction l = direction_of(f, pose);
      const double u = x * l.cos + y * l.sin, v = y * l.cos - x * l.sin;
      const double du = u - f.x, dv = v - f.y, span = reach + f.reach;
      if (du * du + dv * dv > span * span) continue;
      const double d2 = closest_of(shell, shell.runs[static_cast<std::size_t>(f.run)], u, v).foot.d2;
      if (d2 < reach * reach) out.push_back({feature, std::sqrt(d2)});
    }
  };
  // Only lifters whose bounding circle can be in reach: |angle| <= asin(span / rho).
  const int n = shell.lifter_count;
  const double span = reach + shell.lifter_reach;
  const double pitch = 2 * kPi / n;
  const int each_side = span < rho ? static_cast<int>(std::asin(span / rho) / pitch) + 1 : n;
  if (2 * each_side + 1 >= n) {
    for (int k = 0; k < n; ++k) add_if_near(k);
    return;
  }
  const double u = x * pose.cos + y * pose.sin, v = y * pose.cos - x * pose.sin;
  const auto nearest = static_cast<int>(std::floor(std::atan2(v, u) / pitch + 0.5));
  for (int k = nearest - each_side; k <= nearest + each_side; ++k) add_if_near(((k % n) + n) % n);
  std::sort(out.begin() + first, out.end(),
            [](const NearFeature& a, const NearFeature& b) { return a.feature < b.feature; });
}

int lifter_around(const Shell& shell, double x, double y) {
  if (std::hypot(x, y) <= shell.tip_radius) return -1;
  for (const Feature& f : shell.features) {
    const double u = x * f.cos + y * f.sin, v = y * f.cos - x * f.sin;
    if (in_steel(shell, shell.runs[static_cast<std::size_t>(f.run)].section, u, v)) return f.lifter;
  }
  return -1;
}

}  // namespace tumble::sim
