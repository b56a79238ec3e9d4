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

Vec2 centre_of(const Canvas& canvas) { return canvas.layout.camera.axis(); }

bool is_within(const Box& box, const Vec2& p) {
  return p.x() >= box.left && p.x() <= box.right && p.y() >= box.top && p.y() <= box.bottom;
}

// Lets notes be read over the mill.
void draw_plate(Canvas& canvas, const Box& box) {
  const double gap = canvas.px(12);
  canvas.meshes.rectangle(box.left - gap, box.top - gap, box.right + gap, box.bottom + gap,
                          with_alpha(canvas.theme.ground, 0.72));
}

TextStyle key_style(const Canvas& canvas) { return {canvas.letter(12), canvas.theme.quiet}; }
double key_line(const Canvas& canvas) { return std::max(canvas.px(19), 1.35 * key_style(canvas).size); }
double key_indent(const Canvas& canvas) { return canvas.px(24 + 8); }  // the line's sample, and a gap

bool overlap(const Box& a, const Box& b, double gap) {
  return a.left < b.right + gap && b.left < a.right + gap && a.top < b.bottom + gap && b.top < a.bottom + gap;
}

// Name over value at the mill's sides, both in one line where there is little room: above and below it.
struct Label {
  Label(Canvas& canvas, const MillShape& shape, const RimMark& mark, double at_deg)
      : small{canvas.letter(12.5), mark.colour},
        large{canvas.letter(14.5), canvas.theme.text, Weight::kBold},
        has_name(canvas.layout.unit >= 0.4),
        value(fmt::format("{:.0f}°", wrap_360(std::round(mark.angle_deg)))),
        name_width(has_name ? canvas.text.width(mark.name, small) : 0),
        value_width(canvas.text.width(value, large)) {
    const Vec2 out = canvas.layout.camera.direction(radians(at_deg));
    one_line = std::abs(out.y()) > 0.86;
    line = one_line || !has_name ? 0 : 1.28 * small.size;
    const double width =
        one_line ? name_width + (has_name ? canvas.px(6) : 0) + value_width : std::max(name_width, value_width);
    const double height = line + 0.8 * large.size;
    // The label's box touches the circle around the pointer from outside, and stays inside the picture.
    const double reach = canvas.px(18.5) + (std::abs(out.x()) * width + std::abs(out.y()) * height) / 2;
    const Box& picture = canvas.layout.picture;
    const double margin = canvas.px(5);
    const Vec2 middle = centre_of(canvas) + (rim_radius(canvas, shape) + reach) * out;
    const double x = std::clamp(middle.x(), picture.left + margin + width / 2, picture.right - margin - width / 2);
    const double y = std::clamp(middle.y(), picture.top + margin + height / 2, picture.bottom - margin - height / 2);
    is_on_rim = (Vec2(x, y) - middle).norm() > canvas.px(6);
    box = {x - width / 2, y - height / 2, x + width / 2, y + height / 2};
  }

  void draw(Canvas& canvas, const char* name) const {
    const double x = (box.left + box.right) / 2;
    const auto add = [&](std::string_view words, double left, double baseline, const TextStyle& style) {
      is_on_rim ? add_on_charge(canvas, words, left, baseline, style) : canvas.text.add(words, left, baseline, style);
    };
    if (has_name) add(name, one_line ? box.left : x - name_width / 2, box.bottom - line, small);
    add(value, one_line ? box.right - value_width : x - value_width / 2, box.bottom, large);
  }

  TextStyle small, large;
  bool has_name;  // a tiny picture has room for the angle alone
  std::string value;
  double name_width, value_width, line = 0;
  bool one_line = false, is_on_rim = false;  // pushed there by the picture's edge
  Box box;
};

// Whether it can be seen: a closer view may leave it out.
bool draw_pointer(Canvas& canvas, const MillShape& shape, const RimMark& mark) {
  const double rim = rim_radius(canvas, shape);
  const Vec2 out = canvas.layout.camera.direction(radians(mark.angle_deg)), side(-out.y(), out.x());
  const Vec2 centre = centre_of(canvas);
  const double foot = rim + canvas.px(2.5), end = foot + canvas.px(11);
  if (!is_within(canvas.layout.view, centre + end * out)) return false;
  const Vec2 pointer[] = {centre + foot * out, centre + end * out + canvas.px(4.6) * side,
                          centre + end * out - canvas.px(4.6) * side};
  canvas.meshes.convex(pointer, mark.colour);
  // Across the rim's steel, where no ball can be.
  canvas.meshes.line(centre + rim * out, centre + shape.radius * canvas.layout.camera.pixels_per_metre * out,
                     canvas.stroke(1.3), mark.colour);
  return true;
}

}  // namespace

void draw_rim_marks(Canvas& canvas, const MillShape& shape, std::span<const RimMark> marks, const Box& kept_free) {
  constexpr double kStep = 1, kFarthest = 30;  // by which a label makes way [degrees]
  std::vector<Box> taken{kept_free};
  for (const RimMark& mark : marks) {
    if (std::isnan(mark.angle_deg) || !draw_pointer(canvas, shape, mark)) continue;
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
  const double from = canvas.layout.camera.angle_in_picture(toe),
               to = canvas.layout.camera.angle_in_picture(toe + span);
  const double radius = rim_radius(canvas, shape) + canvas.px(6.5), half = canvas.stroke(1.1) / 2;
  canvas.meshes.ring(centre_of(canvas), radius - half, radius + half, std::min(from, to), std::max(from, to),
                     with_alpha(canvas.theme.accent, 0.55));
}

void add_on_charge(Canvas& canvas, std::string_view words, double x, double baseline, const TextStyle& style) {
  TextStyle outlined = style;
  outlined.halo = with_alpha(canvas.theme.halo, 0.8);
  outlined.halo_width = std::max(1.0, canvas.px(1.2));
  canvas.text.add(words, x, baseline, outlined);
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
                     canvas.theme.quiet);
  const Vec2 out = canvas.layout.camera.direction(end);
  const Vec2 ahead = canvas.layout.camera.direction(end + sense * kPi / 2);
  const Vec2 tip = centre_of(canvas) + radius * out;
  const Vec2 head[] = {tip + canvas.px(11) * ahead, tip + canvas.px(5.5) * out, tip - canvas.px(5.5) * out};
  canvas.meshes.convex(head, canvas.theme.quiet);
}

void draw_gravity(Canvas& canvas) {
  const Box& view = canvas.layout.view;
  const Vec2 centre(view.left + canvas.px(48), view.top + canvas.px(42));
  const double radius = canvas.px(24);
  const double half = canvas.stroke(1.0) / 2;
  canvas.meshes.ring(centre, 0, radius, 0, 2 * kPi, with_alpha(canvas.theme.ground, 0.6));
  canvas.meshes.ring(centre, radius - half, radius + half, 0, 2 * kPi, canvas.theme.faint);
  const Vec2 down = canvas.layout.camera.direction(-kPi / 2);
  draw_arrow(canvas, centre - 0.72 * radius * down, centre + 0.86 * radius * down, canvas.px(2.4), canvas.theme.text);
  const TextStyle label{canvas.letter(12), canvas.theme.quiet, Weight::kRegular, Align::kCentre};
  canvas.text.add("gravity", centre.x(), centre.y() + radius + 1.2 * label.size, label);
}

void draw_scale_bar(Canvas& canvas, const Vec2& left_end, double shell_radius, double arrow_seconds,
                    bool is_over_mill) {
  const Camera& camera = canvas.layout.camera;
  const double length = round_number_below(0.45 * shell_radius / canvas.layout.zoom);  // [m]
  const double width = length * camera.pixels_per_metre;
  const double left = left_end.x(), baseline = left_end.y(), tick = canvas.px(4);
  if (is_over_mill)
    draw_plate(canvas, {left, baseline - canvas.px(std::isnan(arrow_seconds) ? 16 : 52), left + width, baseline});
  const double w = canvas.stroke(1.6);
  canvas.meshes.line({left, baseline}, {left + width, baseline}, w, canvas.theme.quiet);
  canvas.meshes.line({left, baseline - tick}, {left, baseline + tick}, w, canvas.theme.quiet);
  canvas.meshes.line({left + width, baseline - tick}, {left + width, baseline + tick}, w, canvas.theme.quiet);
  const TextStyle label{canvas.letter(13), canvas.theme.quiet, Weight::kRegular, Align::kCentre};
  const std::string text = length >= 1 ? fmt::format("{:.0f} m", length) : fmt::format("{:.0f} mm", 1000 * length);
  canvas.text.add(text, left + width / 2, baseline - canvas.px(8), label);

  if (std::isnan(arrow_seconds)) return;
  const double speed = round_number_below(0.25 * shell_radius / canvas.layout.zoom / arrow_seconds);
  const double arrow = speed * arrow_seconds * camera.pixels_per_metre, above = baseline - canvas.px(34);
  draw_arrow(canvas, {left, above}, {left + arrow, above}, canvas.px(2.0), canvas.theme.text);
  canvas.text.add(fmt::format("{:g} m/s", speed), left + arrow / 2, above - canvas.px(9), label);
}

Key make_key(Canvas& canvas, const Vec2& corner, Align side, const Overlay& overlay, const ChainScale& chains) {
  Key key;
  if (overlay.surface) key.rows.push_back({canvas.theme.accent, canvas.stroke(2.6), "free surface"});
  if (overlay.streamlines) key.rows.push_back({canvas.theme.flow, canvas.stroke(1.6), "mean flow"});
  if (overlay.occupancy) key.rows.push_back({canvas.theme.trace, canvas.stroke(1.8), "occupancy"});
  if (overlay.chains) {
    const double force = round_number_below(chains.force);
    key.rows.push_back({canvas.theme.force, chains.width * chains.share_of(force), fmt::format("force {:g} N", force)});
  }
  const TextStyle style = key_style(canvas);
  double width = 0;
  for (const Key::Row& row : key.rows)
    width = std::max(width, key_indent(canvas) + canvas.text.width(row.words, style));
  const double left = side == Align::kRight ? corner.x() - width : corner.x();
  const double below = key_line(canvas) * (static_cast<double>(key.rows.size()) - 1);
  key.box = {left, corner.y() - 0.8 * style.size, left + width, corner.y() + below};
  return key;
}

void draw_key(Canvas& canvas, const Key& key, bool is_over_mill) {
  if (key.rows.empty()) return;
  if (is_over_mill) draw_plate(canvas, key.box);
  const TextStyle style = key_style(canvas);
  double baseline = key.box.top + 0.8 * style.size;
  for (const Key::Row& row : key.rows) {
    const double y = std::round(baseline - 0.36 * style.size);
    canvas.meshes.line({key.box.left, y}, {key.box.left + canvas.px(24), y}, row.width, row.colour);
    canvas.text.add(row.words, key.box.left + key_indent(canvas), baseline, style);
    baseline += key_line(canvas);
  }
}

}  // namespace tumble::render
