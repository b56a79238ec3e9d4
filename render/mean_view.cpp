#include "render/mean_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "render/charge_view.h"
#include "render/marks.h"
#include "render/stream_function.h"

namespace tumble::render {
namespace {

constexpr int kStreamlines = 8;
constexpr double kLeastLine = 0.4;     // length of a line that is drawn, in shell radii: shorter ones are noise
constexpr double kSmooth = 0.15;       // by which a line may be off [px]
constexpr int kArrowEvery = 2;         // cells
constexpr double kLeastCovered = 0.1;  // occupancy from which a cell's mean velocity gets an arrow

double length_of(const Contour& line) {
  double sum = 0;
  for (std::size_t i = 1; i < line.points.size(); ++i) sum += (line.points[i] - line.points[i - 1]).norm();
  return sum;
}

std::vector<Contour> lines_at(const Grid& grid, double level, double least, double pixel) {
  std::vector<Contour> lines;
  for (const Contour& line : contours(grid, level))
    if (length_of(line) >= least) lines.push_back(rounded(line, kSmooth * pixel));
  return lines;
}

// In the picture; a closed line ends where it began.
std::vector<Vec2> seen(const Canvas& canvas, const Contour& line) {
  std::vector<Vec2> points;
  for (const auto& p : line.points) points.push_back(canvas.layout.camera.image_from_mill(p.x(), p.y()));
  if (line.closed) points.push_back(points.front());
  return points;
}

void outlined(Canvas& canvas, std::span<const Vec2> points, double width, Rgba colour) {
  canvas.meshes.polyline(points, width + 2 * canvas.stroke(1.1), with_alpha(canvas.theme.halo, 0.7));
  canvas.meshes.polyline(points, width, colour);
}

// Arrow heads along a line, evenly spaced.
void draw_heads(Canvas& canvas, std::span<const Vec2> points, Rgba colour) {
  const double spacing = canvas.px(95), size = std::max(canvas.px(5.5), 3.0);
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  const int count = std::max(1, static_cast<int>(length / spacing));
  double gone = 0, next = length / count / 2;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec2 way = points[i] - points[i - 1];
    const double step = way.norm();
    for (; step > 0 && next <= gone + step; next += length / count) {
      const Vec2 along = way / step, side(-along.y(), along.x()), at = points[i - 1] + (next - gone) * along;
      const Vec2 head[] = {at + size * along, at - 0.6 * size * along + 0.72 * size * side,
                           at - 0.6 * size * along - 0.72 * size * side};
      canvas.meshes.convex(head, colour);
    }
    gone += step;
  }
}

void draw_occupancy(Canvas& canvas, const MeanView& mean) {
  const TextStyle style{canvas.letter(11.5), canvas.theme.trace, Weight::kBold, Align::kCentre};
  std::vector<Vec2> labels;
  for (const auto& [level, lines] : mean.occupancy) {
    std::vector<Vec2> longest;
    for (const Contour& line : lines) {
      const std::vector<Vec2> points = seen(canvas, line);
      outlined(canvas, points, canvas.stroke(1.0 + 1.6 * level), canvas.theme.trace);
      if (points.size() > longest.size()) longest = points;
    }
    // The labels stand where a line comes near the axis, for there balls are few, but not upon one another.
    const Vec2 axis = canvas.layout.camera.axis();
    std::stable_sort(longest.begin(), longest.end(),
                     [&](const Vec2& a, const Vec2& b) { return (a - axis).norm() < (b - axis).norm(); });
    for (const Vec2& at : longest) {
      if (std::any_of(labels.begin(), labels.end(), [&](const Vec2& l) { return (l - at).norm() < 3.6 * style.size; }))
        continue;
      add_on_charge(canvas, fmt::format("{:.0f} %", 100 * level), at.x(), at.y() + 0.36 * style.size, style);
      labels.push_back(at);
      break;
    }
  }
}

void draw_arrows(Canvas& canvas, const MeanView& mean, double seconds) {
  const Field& f = mean.field;
  const Grid grid{f.n, f.cell, {}};
  const Camera& camera = canvas.layout.camera;
  for (int j = 0; j < f.n; j += kArrowEvery) {
    for (int i = 0; i < f.n; i += kArrowEvery) {
      const auto k = static_cast<std::size_t>(j) * f.n + i;
      if (!(f.occupancy[k] >= kLeastCovered) || std::isnan(f.vx[k]) || std::isnan(f.vy[k])) continue;
      const double x = grid.place(i), y = grid.place(j);
      const double vx = f.vx[k] + camera.turning * y, vy = f.vy[k] - camera.turning * x;  // in the picture's frame
      draw_arrow(canvas, camera.image_from_mill(x, y), camera.image_from_mill(x + seconds * vx, y + seconds * vy),
                 canvas.stroke(1.7), canvas.theme.flow);
    }
  }
}

// As wide as the mill is at that height, dashed: the charge's head is a height, not a place. It is named on the side
// where the mill goes down, below the line: there balls are fewest.
void draw_head(Canvas& canvas, const MillShape& shape, double head) {
  const Camera& camera = canvas.layout.camera;
  const double half = std::sqrt(std::max(0.0, shape.tip_radius * shape.tip_radius - head * head));
  const double dash = canvas.px(9) / camera.pixels_per_metre;  // [m]
  for (double x = -half; x < half; x += 2 * dash) {
    const Vec2 part[] = {camera.image_from_mill(x, head), camera.image_from_mill(std::min(x + dash, half), head)};
    outlined(canvas, part, canvas.stroke(1.5), canvas.theme.second);
  }
  const TextStyle style{canvas.letter(12.5), canvas.theme.second, Weight::kBold, Align::kCentre};
  const std::string words = fmt::format("head {}{:.0f} mm", head < 0 ? "−" : "", std::abs(1000 * head));
  // Clear of the line however a view turns it.
  const Vec2 down = camera.direction(-kPi / 2);
  const double off =
      canvas.px(6) + (std::abs(down.y()) * style.size + std::abs(down.x()) * canvas.text.width(words, style)) / 2;
  const Vec2 middle = camera.image_from_mill(-0.45 * half, head) + off * down;
  add_on_charge(canvas, words, middle.x(), middle.y() + 0.4 * style.size, style);
}

void draw_centre(Canvas& canvas, double x, double y) {
  const Vec2 at = canvas.layout.camera.image_from_mill(x, y);
  const double r = canvas.px(8), arm = canvas.px(14), w = canvas.stroke(1.8);
  for (const bool halo : {true, false}) {
    const double grow = halo ? canvas.stroke(1.1) : 0;
    const Rgba ink = halo ? with_alpha(canvas.theme.halo, 0.65) : canvas.theme.second;
    canvas.meshes.ring(at, r - w / 2 - grow, r + w / 2 + grow, 0, 2 * kPi, ink);
    canvas.meshes.line(at - Vec2(arm + grow, 0), at + Vec2(arm + grow, 0), w + 2 * grow, ink);
    canvas.meshes.line(at - Vec2(0, arm + grow), at + Vec2(0, arm + grow), w + 2 * grow, ink);
  }
  const TextStyle style{canvas.letter(12.5), canvas.theme.second, Weight::kBold, Align::kLeft};
  add_on_charge(canvas, "CoC", at.x() + arm + canvas.px(3), at.y() - canvas.px(5), style);
}

// Where single balls lie in the lifters' pockets the surface leaps from one to the other: no line joins these.
std::vector<Contour> surface_pieces(const ChargeMotion& motion, double pixel) {
  const double leap = 0.12 * motion.mill_radius;
  std::vector<Contour> pieces(1);
  for (const SurfacePoint& p : motion.surface) {
    const Eigen::Vector2d at(p.x, p.y);
    auto& now = pieces.back().points;
    if (!now.empty() && (at - now.back()).norm() > leap) pieces.emplace_back();
    pieces.back().points.push_back(at);
  }
  std::erase_if(pieces, [](const Contour& piece) { return piece.points.size() < 3; });
  for (Contour& piece : pieces) piece = rounded(piece, kSmooth * pixel);
  return pieces;
}

}  // namespace

MeanView make_mean_view(const ChargeMotion& motion, const Overlay& wanted, double pixel) {
  MeanView view;
  const Field& field = motion.field;
  const double least = kLeastLine * motion.mill_radius;
  if (wanted.occupancy && field.n > 0) {
    const Grid grid = smoothed({field.n, field.cell, field.occupancy});
    for (const double level : {0.2, 0.4, 0.6, 0.8})
      view.occupancy.push_back({level, lines_at(grid, level, least, pixel)});
  }
  if (wanted.streamlines && field.n > 0) {
    const Grid psi = stream_function(field, motion.mill_radius);
    const auto [low, high] = std::minmax_element(psi.value.begin(), psi.value.end());
    const double peak = std::abs(*low) > std::abs(*high) ? *low : *high;  // > 0 where the charge turns with the mill
    for (int k = 0; k < kStreamlines; ++k) {
      for (Contour& line : lines_at(psi, (k + 0.5) / kStreamlines * peak, least, pixel))
        view.streamlines.push_back(std::move(line));
    }
  }
  if (wanted.surface) view.surface = surface_pieces(motion, pixel);
  if (wanted.mean_velocity) view.field = field;
  view.head = motion.head.value;
  view.centre_x = motion.centre_of_circulation_x.value;
  view.centre_y = motion.centre_of_circulation_y.value;
  view.departure_deg = motion.departure_deg.value;
  view.impact_toe_deg = motion.impact_toe_deg.value;
  return view;
}

void draw_mean(Canvas& canvas, const MillShape& shape, const MeanView& mean, const Overlay& overlay,
               double arrow_seconds) {
  if (overlay.occupancy) draw_occupancy(canvas, mean);
  if (overlay.streamlines) {
    for (const Contour& line : mean.streamlines) {
      const std::vector<Vec2> points = seen(canvas, line);
      outlined(canvas, points, canvas.stroke(1.6), with_alpha(canvas.theme.flow, 0.9));
      draw_heads(canvas, points, canvas.theme.flow);
    }
  }
  if (overlay.mean_velocity) draw_arrows(canvas, mean, arrow_seconds);
  if (overlay.surface)
    for (const Contour& piece : mean.surface)
      outlined(canvas, seen(canvas, piece), canvas.stroke(2.6), canvas.theme.accent);
  if (overlay.head && !std::isnan(mean.head)) draw_head(canvas, shape, mean.head);
  if (overlay.circulation && !std::isnan(mean.centre_x + mean.centre_y))
    draw_centre(canvas, mean.centre_x, mean.centre_y);
}

}  // namespace tumble::render
