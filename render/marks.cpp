#include "render/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/angle.h"
#include "render/axis.h"
#include "render/charge_view.h"

namespace tumble::render {
namespace {

double rim_radius(const Canvas& canvas, const MillShape& shape) {
  return shape.radius * kRimShare * canvas.layout.camera.pixels_per_metre;
}

Vec2 centre_of(const Canvas& canvas) { return {canvas.layout.camera.centre_u, canvas.layout.camera.centre_v}; }

// Corners left of the mill, above and below it, where scale and key stand: near the mill, and inside the picture.
double corner_left(const Canvas& canvas) {
  return std::max(canvas.layout.picture.left + canvas.px(28), canvas.layout.camera.centre_u - canvas.px(372));
}
double corner_top(const Canvas& canvas) {
  return std::max(canvas.layout.picture.top + canvas.px(34), canvas.layout.camera.centre_v - canvas.px(326));
}
double corner_bottom(const Canvas& canvas) {
  return std::min(canvas.layout.picture.bottom - canvas.px(30), canvas.layout.camera.centre_v + canvas.px(330));
}

// The same direction as an angle in the picture: a mirrored mill is seen from its other end.
double angle_in_picture(const Canvas& canvas, double angle_rad) {
  return canvas.layout.camera.mirror ? kPi - angle_rad : angle_rad;
}

bool overlap(const Box& a, const Box& b, double gap) {
  return a.left < b.right + gap && b.left < a.right + gap && a.top < b.bottom + gap && b.top < a.bottom + gap;
}

// Name over value at the mill's sides, both in one line where there is little room: above and below it.
struct Label {
  Label(Canvas& canvas, const MillShape& shape, const RimMark& mark, double at_deg)
      : small{canvas.letter(12.5), mark.colour},
        large{canvas.letter(14.5), canvas.theme.text, Weight::kBold},
        value(fmt::format("{:.0f}°", wrap_360(std::round(mark.angle_deg)))),
        name_width(canvas.text.width(mark.name, small)),
        value_width(canvas.text.width(value, large)) {
    const Vec2 out = canvas.layout.camera.direction(radians(at_deg));
    one_line = std::abs(out.y()) > 0.86;
    line = one_line ? 0 : 1.28 * small.size;
    const double width = one_line ? name_width + canvas.px(6) + value_width : std::max(name_width, value_width);
    const double height = line + 0.8 * large.size;
    // The label's box touches the circle around the pointer from outside, and stays inside the picture.
    const double reach = canvas.px(18.5) + (std::abs(out.x()) * width + std::abs(out.y()) * height) / 2;
    const Box& picture = canvas.layout.picture;
    const double margin = canvas.px(5);
    const Vec2 middle = centre_of(canvas) + (rim_radius(canvas, shape) + reach) * out;
    const double x = std::clamp(middle.x(), picture.left + margin + width / 2, picture.right - margin - width / 2);
    const double y = std::clamp(middle.y(), picture.top + margin + height / 2, picture.bottom - margin - height / 2);
    box = {x - width / 2, y - height / 2, x + width / 2, y + height / 2};
  }

  void draw(Canvas& canvas, const char* name) const {
    const double x = (box.left + box.right) / 2;
    canvas.text.add(name, one_line ? box.left : x - name_width / 2, box.bottom - line, small);
    canvas.text.add(value, one_line ? box.right - value_width : x - value_width / 2, box.bottom, large);
  }

  TextStyle small, large;
  std::string value;
  double name_width, value_width, line = 0;
  bool one_line = false;
  Box box;
};

void draw_pointer(Canvas& canvas, const MillShape& shape, const RimMark& mark) {
  const double rim = rim_radius(canvas, shape);
  const Vec2 out = canvas.layout.camera.direction(radians(mark.angle_deg)), side(-out.y(), out.x());
  const Vec2 centre = centre_of(canvas);
  const double foot = rim + canvas.px(2.5), end = foot + canvas.px(11);
  const Vec2 pointer[] = {centre + foot * out, centre + end * out + canvas.px(4.6) * side,
                          centre + end * out - canvas.px(4.6) * side};
  canvas.meshes.convex(pointer, mark.colour);
  // Across the rim's steel, where no ball can be.
  canvas.meshes.line(centre + rim * out, centre + shape.radius * canvas.layout.camera.pixels_per_metre * out,
                     canvas.stroke(1.3), mark.colour);
}

}  // namespace

void draw_rim_marks(Canvas& canvas, const MillShape& shape, std::span<const RimMark> marks) {
  constexpr double kStep = 1, kFarthest = 30;  // by which a label makes way [degrees]
  std::vector<Box> taken;
  for (const RimMark& mark : marks) {
    if (std::isnan(mark.angle_deg)) continue;
    draw_pointer(canvas, shape, mark);
    const auto free_at = [&](double at_deg) {
      const Box box = Label(canvas, shape, mark, at_deg).box;
      return std::none_of(taken.begin(), taken.end(), [&](const Box& b) { return overlap(box, b, canvas.px(3)); });
    };
    double at = mark.angle_deg;
    for (double off = kStep; !free_at(at) && off <= kFarthest; off = off > 0 ? -off : -off + kStep)
      at = mark.angle_deg + off;
    const Label label(canvas, shape, mark, at);
    label.draw(canvas, mark.name);
    taken.push_back(label.box);
  }
}

void draw_charge_arc(Canvas& canvas, const MillShape& shape, double toe_deg, double shoulder_deg) {
  if (std::isnan(toe_deg) || std::isnan(shoulder_deg)) return;
  // The charge lies counter-clockwise from toe to shoulder.
  const double toe = radians(toe_deg), span = radians(wrap_360(shoulder_deg - toe_deg));
  const double from = angle_in_picture(canvas, toe), to = angle_in_picture(canvas, toe + span);
  const double radius = rim_radius(canvas, shape) + canvas.px(6.5), half = canvas.stroke(1.1) / 2;
  canvas.meshes.ring(centre_of(canvas), radius - half, radius + half, std::min(from, to), std::max(from, to),
                     with_alpha(canvas.theme.accent, 0.55));
}

void add_on_charge(Canvas& canvas, std::string_view words, double x, double baseline, const TextStyle& style) {
  TextStyle halo = style;
  halo.colour = with_alpha(canvas.theme.halo, 0.8);
  const double off = std::max(1.0, canvas.px(1.2));
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      if (dx != 0 || dy != 0) canvas.text.add(words, x + dx * off, baseline + dy * off, halo);
  canvas.text.add(words, x, baseline, style);
}

void draw_rotation(Canvas& canvas, const MillShape& shape, double speed) {
  if (speed == 0 || std::isnan(speed)) return;
  const double radius = rim_radius(canvas, shape) + canvas.px(13);
  const double sense = speed > 0 ? 1.0 : -1.0;
  const double start = radians(135 - sense * 9), end = radians(135 + sense * 7);  // upper left, where no charge is
  const double from = angle_in_picture(canvas, start), to = angle_in_picture(canvas, end);
  const double half = canvas.stroke(2.0) / 2;
  canvas.meshes.ring(centre_of(canvas), radius - half, radius + half, std::min(from, to), std::max(from, to),
                     canvas.theme.quiet);
  const Vec2 out = canvas.layout.camera.direction(end);
  const Vec2 ahead = canvas.layout.camera.direction(end + sense * kPi / 2);
  const Vec2 tip = centre_of(canvas) + radius * out;
  const Vec2 head[] = {tip + canvas.px(11) * ahead, tip + canvas.px(5.5) * out, tip - canvas.px(5.5) * out};
  canvas.meshes.convex(head, canvas.theme.quiet);
}

void draw_scale_bar(Canvas& canvas, const MillShape& shape, double arrow_seconds) {
  const Camera& camera = canvas.layout.camera;
  const double length = round_number_below(0.45 * shape.radius);  // [m]
  const double width = length * camera.pixels_per_metre;
  const double left = corner_left(canvas), baseline = corner_bottom(canvas), tick = canvas.px(4);
  const double w = canvas.stroke(1.6);
  canvas.meshes.line({left, baseline}, {left + width, baseline}, w, canvas.theme.quiet);
  canvas.meshes.line({left, baseline - tick}, {left, baseline + tick}, w, canvas.theme.quiet);
  canvas.meshes.line({left + width, baseline - tick}, {left + width, baseline + tick}, w, canvas.theme.quiet);
  const TextStyle label{canvas.letter(13), canvas.theme.quiet, Weight::kRegular, Align::kCentre};
  const std::string text = length >= 1 ? fmt::format("{:.0f} m", length) : fmt::format("{:.0f} mm", 1000 * length);
  canvas.text.add(text, left + width / 2, baseline - canvas.px(8), label);

  if (std::isnan(arrow_seconds)) return;
  const double speed = round_number_below(0.25 * shape.radius / arrow_seconds);
  const double arrow = speed * arrow_seconds * camera.pixels_per_metre, above = baseline - canvas.px(34);
  draw_arrow(canvas, {left, above}, {left + arrow, above}, canvas.px(2.0), canvas.theme.text);
  canvas.text.add(fmt::format("{:g} m/s", speed), left + arrow / 2, above - canvas.px(9), label);
}

void draw_key(Canvas& canvas, const Overlay& overlay, const ChainScale& chains) {
  const TextStyle style{canvas.letter(12), canvas.theme.quiet};
  const double left = corner_left(canvas), line = std::max(canvas.px(19), 1.35 * style.size);
  const double sample = canvas.px(24);
  double baseline = corner_top(canvas);
  const auto row = [&](Rgba colour, double width, const std::string& words) {
    const double y = std::round(baseline - 0.36 * style.size);
    canvas.meshes.line({left, y}, {left + sample, y}, width, colour);
    canvas.text.add(words, left + sample + canvas.px(8), baseline, style);
    baseline += line;
  };
  if (overlay.surface) row(canvas.theme.accent, canvas.stroke(2.6), "free surface");
  if (overlay.streamlines) row(canvas.theme.flow, canvas.stroke(1.6), "mean flow");
  if (overlay.occupancy) row(canvas.theme.trace, canvas.stroke(1.8), "occupancy");
  if (overlay.chains) {
    const double force = round_number_below(chains.force);
    row(canvas.theme.force, chains.width * chains.share_of(force), fmt::format("force {:g} N", force));
  }
}

}  // namespace tumble::render
