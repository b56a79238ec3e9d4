#include "render/marks.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/angle.h"
#include "render/axis.h"
#include "render/charge_view.h"

namespace tumble::render {
namespace {

double rim_radius(const Canvas& canvas, const MillShape& shape) {
  return shape.radius * kRimShare * canvas.layout.camera.pixels_per_metre;
}

Vec2 centre_of(const Canvas& canvas) { return canvas.layout.camera.axis(); }

bool is_within(const Box& box, const Vec2& p) {
  return p.x() >= box.left && p.x() <= box.right && p.y() >= box.top && p.y() <= box.bottom;
}

void draw_pointer(Canvas& canvas, const MillShape& shape, const char* name, double angle_deg) {
  const double rim = rim_radius(canvas, shape);
  const Vec2 out = canvas.layout.camera.direction(radians(angle_deg)), side(-out.y(), out.x());
  const Vec2 centre = centre_of(canvas);
  const double foot = rim + canvas.px(2.5), end = foot + canvas.px(11);
  if (!is_within(canvas.layout.view, centre + end * out)) return;  // a closer view may leave it out
  const Vec2 pointer[] = {centre + foot * out, centre + end * out + canvas.px(4.6) * side,
                          centre + end * out - canvas.px(4.6) * side};
  canvas.meshes.convex(pointer, ink::kAccent);
  // Across the rim's steel, where no ball can be.
  canvas.meshes.line(centre + rim * out, centre + shape.radius * canvas.layout.camera.pixels_per_metre * out,
                     canvas.stroke(1.3), ink::kAccent);

  const bool has_name = canvas.layout.unit >= 0.4;  // a tiny picture has room for the angle alone
  const TextStyle small{canvas.letter(12.5), with_alpha(ink::kAccent, 0.9)};
  const TextStyle large{canvas.letter(14.5), ink::kText, Weight::kBold};
  const std::string value = fmt::format("{:.0f}°", wrap_360(std::round(angle_deg)));
  const double name_width = has_name ? canvas.text.width(name, small) : 0,
               value_width = canvas.text.width(value, large);
  // Name over value at the mill's sides, both in one line where there is little room: above and below it.
  const bool one_line = std::abs(out.y()) > 0.86;
  const double gap = has_name ? canvas.px(6) : 0, line = one_line || !has_name ? 0 : 1.12 * small.size;
  const double width = one_line ? name_width + gap + value_width : std::max(name_width, value_width);
  const double height = line + 0.8 * large.size;
  // The label's box touches the circle around the pointer from outside, and stays inside the picture.
  const double reach = end + canvas.px(5) + (std::abs(out.x()) * width + std::abs(out.y()) * height) / 2;
  const Box& picture = canvas.layout.picture;
  const double margin = canvas.px(5);
  const Vec2 middle = centre + reach * out;
  const double x = std::clamp(middle.x(), picture.left + margin + width / 2, picture.right - margin - width / 2);
  const double y = std::clamp(middle.y(), picture.top + margin + height / 2, picture.bottom - margin - height / 2);
  const double baseline = y + height / 2;
  if (has_name) canvas.text.add(name, one_line ? x - width / 2 : x - name_width / 2, baseline - line, small);
  canvas.text.add(value, one_line ? x + width / 2 - value_width : x - value_width / 2, baseline, large);
}

}  // namespace

void draw_toe_and_shoulder(Canvas& canvas, const MillShape& shape, double toe_deg, double shoulder_deg) {
  if (!std::isnan(toe_deg) && !std::isnan(shoulder_deg)) {
    // The charge lies counter-clockwise from toe to shoulder.
    const double toe = radians(toe_deg), span = radians(wrap_360(shoulder_deg - toe_deg));
    const Camera& camera = canvas.layout.camera;
    const double from = camera.angle_in_picture(toe), to = camera.angle_in_picture(toe + span);
    const double radius = rim_radius(canvas, shape) + canvas.px(6.5), half = canvas.stroke(1.1) / 2;
    canvas.meshes.ring(centre_of(canvas), radius - half, radius + half, std::min(from, to), std::max(from, to),
                       with_alpha(ink::kAccent, 0.55));
  }
  if (!std::isnan(toe_deg)) draw_pointer(canvas, shape, "toe", toe_deg);
  if (!std::isnan(shoulder_deg)) draw_pointer(canvas, shape, "shoulder", shoulder_deg);
}

void draw_rotation(Canvas& canvas, const MillShape& shape, double speed) {
  if (speed == 0 || std::isnan(speed)) return;
  const double radius = rim_radius(canvas, shape) + canvas.px(13);
  const double sense = speed > 0 ? 1.0 : -1.0;
  const double start = radians(135 - sense * 9), end = radians(135 + sense * 7);  // upper left, where no charge is
  const Camera& camera = canvas.layout.camera;
  const double from = camera.angle_in_picture(start), to = camera.angle_in_picture(end);
  const double half = canvas.stroke(2.0) / 2;
  canvas.meshes.ring(centre_of(canvas), radius - half, radius + half, std::min(from, to), std::max(from, to),
                     ink::kQuiet);
  const Vec2 out = canvas.layout.camera.direction(end);
  const Vec2 ahead = canvas.layout.camera.direction(end + sense * kPi / 2);
  const Vec2 tip = centre_of(canvas) + radius * out;
  const Vec2 head[] = {tip + canvas.px(11) * ahead, tip + canvas.px(5.5) * out, tip - canvas.px(5.5) * out};
  canvas.meshes.convex(head, ink::kQuiet);
}

void draw_gravity(Canvas& canvas) {
  const Box& view = canvas.layout.view;
  const Vec2 centre(view.left + canvas.px(48), view.top + canvas.px(42));
  const double radius = canvas.px(24);
  const double half = canvas.stroke(1.0) / 2;
  canvas.meshes.ring(centre, 0, radius, 0, 2 * kPi, with_alpha(ink::kGround, 0.6));
  canvas.meshes.ring(centre, radius - half, radius + half, 0, 2 * kPi, ink::kFaint);
  const Vec2 down = canvas.layout.camera.direction(-kPi / 2);
  draw_arrow(canvas, centre - 0.72 * radius * down, centre + 0.86 * radius * down, canvas.px(2.4), ink::kText);
  const TextStyle label{canvas.letter(12), ink::kQuiet, Weight::kRegular, Align::kCentre};
  canvas.text.add("gravity", centre.x(), centre.y() + radius + 1.2 * label.size, label);
}

void draw_scale_bar(Canvas& canvas, const Vec2& left_end, double shell_radius, double arrow_seconds,
                    bool is_over_mill) {
  const Camera& camera = canvas.layout.camera;
  const double length = round_number_below(0.45 * shell_radius / canvas.layout.zoom);  // [m]
  const double width = length * camera.pixels_per_metre;
  const double left = left_end.x(), baseline = left_end.y(), tick = canvas.px(4);
  if (is_over_mill)
    canvas.meshes.rectangle(left - canvas.px(12), baseline - canvas.px(std::isnan(arrow_seconds) ? 28 : 64),
                            left + width + canvas.px(12), baseline + canvas.px(12), with_alpha(ink::kGround, 0.72));
  const double w = canvas.stroke(1.6);
  canvas.meshes.line({left, baseline}, {left + width, baseline}, w, ink::kQuiet);
  canvas.meshes.line({left, baseline - tick}, {left, baseline + tick}, w, ink::kQuiet);
  canvas.meshes.line({left + width, baseline - tick}, {left + width, baseline + tick}, w, ink::kQuiet);
  const TextStyle label{canvas.letter(13), ink::kQuiet, Weight::kRegular, Align::kCentre};
  const std::string text = length >= 1 ? fmt::format("{:.0f} m", length) : fmt::format("{:.0f} mm", 1000 * length);
  canvas.text.add(text, left + width / 2, baseline - canvas.px(8), label);

  if (std::isnan(arrow_seconds)) return;
  const double speed = round_number_below(0.25 * shell_radius / canvas.layout.zoom / arrow_seconds);
  const double arrow = speed * arrow_seconds * camera.pixels_per_metre, above = baseline - canvas.px(34);
  draw_arrow(canvas, {left, above}, {left + arrow, above}, canvas.px(2.0), ink::kText);
  canvas.text.add(fmt::format("{:g} m/s", speed), left + arrow / 2, above - canvas.px(9), label);
}

}  // namespace tumble::render
