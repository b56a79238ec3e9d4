#include "io/report/mill_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/angle.h"
#include "io/report/html.h"

namespace tumble::io::report {
namespace {

constexpr double kScale = 100;  // the shell's radius in the picture's units
constexpr int kShades = 8;
constexpr int kArrowsAcross = 22;

// Picture units from metres; y stays up, the picture's group turns it over.
struct Canvas {
  double per_metre;
  std::string point(double x, double y) const { return fmt::format("{:.2f} {:.2f}", x * per_metre, y * per_metre); }
};

// Cells of like shade in a row become one rectangle, rectangles of one shade one path: some kilobytes in all.
std::string shades(const Field& field, const Canvas& canvas) {
  const auto n = static_cast<std::size_t>(field.n);
  if (field.occupancy.size() != n * n || n == 0) return "";
  std::array<std::string, kShades> paths;
  const double cell = field.cell * canvas.per_metre, low = -cell * static_cast<double>(n) / 2;
  const auto shade = [&](std::size_t row, std::size_t column) {
    const double o = field.occupancy[row * n + column];
    return o > 0 ? std::clamp(static_cast<int>(o * kShades), 0, kShades - 1) : -1;
  };
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t begin = 0; begin < n;) {
      std::size_t end = begin + 1;
      const int s = shade(row, begin);
      while (end < n && shade(row, end) == s) ++end;
      if (s >= 0)
        paths[static_cast<std::size_t>(s)] +=
            fmt::format("M{:.2f} {:.2f}h{:.2f}v{:.2f}h{:.2f}z", low + cell * static_cast<double>(begin),
                        low + cell * static_cast<double>(row), cell * static_cast<double>(end - begin), cell,
                        -cell * static_cast<double>(end - begin));
      begin = end;
    }
  }
  std::string out;
  for (int s = 0; s < kShades; ++s)
    if (const auto& path = paths[static_cast<std::size_t>(s)]; !path.empty())
      out += fmt::format(R"(<path class="shade" opacity="{:.3f}" d="{}"/>)", (s + 0.5) / kShades * 0.8, path);
  return out;
}

// Mean velocities, the longest as long as the arrows' spacing.
std::string arrows(const Field& field, const Canvas& canvas) {
  const int n = field.n;
  if (field.vx.size() != field.occupancy.size() || field.vy.size() != field.vx.size() || field.vx.empty()) return "";
  const int stride = std::max(1, n / kArrowsAcross);
  double fastest = 0;
  for (std::size_t i = 0; i < field.vx.size(); ++i)
    if (const double v = std::hypot(field.vx[i], field.vy[i]); v > fastest && field.occupancy[i] > 0.1) fastest = v;
  if (!(fastest > 0)) return "";
  const double length = 1.3 * stride * field.cell / fastest;
  std::string path;
  for (int row = stride / 2; row < n; row += stride) {
    for (int column = stride / 2; column < n; column += stride) {
      const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(column);
      const double dx = field.vx[i] * length, dy = field.vy[i] * length;
      if (!(field.occupancy[i] > 0.05) || !(std::hypot(dx, dy) > 0.2 * stride * field.cell)) continue;
      const double x = (column + 0.5 - n / 2.0) * field.cell, y = (row + 0.5 - n / 2.0) * field.cell;
      const double tx = x + dx / 2, ty = y + dy / 2;  // the tip; the arrow is centred on its cell
      path += fmt::format("M{}L{}", canvas.point(x - dx / 2, y - dy / 2), canvas.point(tx, ty));
      path += fmt::format("M{}L{}L{}", canvas.point(tx - 0.3 * dx - 0.18 * dy, ty - 0.3 * dy + 0.18 * dx),
                          canvas.point(tx, ty), canvas.point(tx - 0.3 * dx + 0.18 * dy, ty - 0.3 * dy - 0.18 * dx));
    }
  }
  return path.empty() ? "" : fmt::format(R"(<path class="arrows" d="{}"/>)", path);
}

std::string ray(const char* style, double deg, double from, double to) {
  if (!std::isfinite(deg)) return "";
  const double c = std::cos(radians(deg)), s = std::sin(radians(deg));
  return fmt::format(R"(<path class="{}" d="M{:.2f} {:.2f}L{:.2f} {:.2f}"/>)", style, from * c, from * s, to * c,
                     to * s);
}

std::string name_at(const char* name, double deg) {
  if (!std::isfinite(deg)) return "";
  const double c = std::cos(radians(deg)), s = std::sin(radians(deg)), r = 112;
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}">{} {:.1f}°</text>)", r * c, -r * s + 3,
                     c > 0.35 ? "start" : (c < -0.35 ? "end" : "middle"), name, deg);
}

std::string cross(const ChargeMotion& m, const Canvas& canvas) {
  const double x = m.centre_of_circulation_x.value * canvas.per_metre;
  const double y = m.centre_of_circulation_y.value * canvas.per_metre;
  if (!std::isfinite(x) || !std::isfinite(y)) return "";
  return fmt::format(R"(<path class="centre" d="M{0:.2f} {1:.2f}h8M{2:.2f} {3:.2f}v8"/>)", x - 4, y, x, y - 4);
}

}  // namespace

std::string mill_picture(const MillShape& shape, const ChargeMotion& motion, const ChargeMotion* other,
                         const std::string& label) {
  const Canvas canvas{kScale / shape.radius};
  const double tip = shape.tip_radius * canvas.per_metre;
  std::string inside;
  for (const auto& p : outline(shape, shape.radius / 40))
    inside += std::string(inside.empty() ? "M" : "L") + canvas.point(p.x(), p.y());

  std::string out =
      fmt::format(R"(<svg class="mill" viewBox="-165 -122 330 244" role="img" aria-label="{}">)", escaped(label));
  out += R"svg(<g transform="scale(1 -1)"><circle class="shell" r="104"/>)svg";
  out += fmt::format(R"(<path class="inside" d="{}z"/>)", inside);
  out += shades(motion.field, canvas) + arrows(motion.field, canvas) + cross(motion, canvas);
  if (other)
    out += ray("other", other->toe_deg.value, tip * 0.8, 108) + ray("other", other->shoulder_deg.value, tip * 0.8, 108);
  out += ray("mark", motion.toe_deg.value, tip * 0.8, 108) + ray("mark", motion.shoulder_deg.value, tip * 0.8, 108);
  out += "</g>";
  out += name_at("toe", motion.toe_deg.value) + name_at("shoulder", motion.shoulder_deg.value);
  return out + "</svg>";
}

}  // namespace tumble::io::report
