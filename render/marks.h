#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/mill_shape.h"
#include "render/canvas.h"
#include "render/charge_view.h"
#include "render/renderer.h"

namespace tumble::render {

// A place on the shell's circle that has a name.
struct RimMark {
  const char* name = "";
  double angle_deg = kNotGiven;  // NaN = no mark
  Rgba colour;
};

// Outside the rim, as the literature draws them: a pointer each, with its name and angle. Labels that would cover one
// another or `kept_free` make way along the rim, later ones for earlier ones. Nothing is drawn over the charge.
void draw_rim_marks(Canvas& canvas, const MillShape& shape, std::span<const RimMark> marks, const Box& kept_free);

// The charge's extent: an arc outside the rim from toe to shoulder; none where one of them is NaN.
void draw_charge_arc(Canvas& canvas, const MillShape& shape, double toe_deg, double shoulder_deg);

// Letters that can be read on balls.
void add_on_charge(Canvas& canvas, std::string_view words, double x, double baseline, const TextStyle& style);

// A curved arrow that shows which way the mill turns; nothing for a mill that stands still. speed in [rad/s].
void draw_rotation(Canvas& canvas, const MillShape& shape, double speed);

// Which way is down, in a corner of a view that turns.
void draw_gravity(Canvas& canvas);

// A bar of a round length from `left_end` on [px], with the key of the velocity arrows (seconds of motion an arrow
// is long) when those are drawn, NaN without them; on a plate where it lies over the mill. Shell's radius in [m].
void draw_scale_bar(Canvas& canvas, const Vec2& left_end, double shell_radius, double arrow_seconds,
                    bool is_over_mill = false);

// What the lines over the charge stand for.
struct Key {
  struct Row {
    Rgba colour;
    double width;  // of the line [px]
    std::string words;
  };
  std::vector<Row> rows;  // none: there is nothing to say
  Box box;
};

// Rows down from `corner` [px], on its right (Align::kLeft) or left side (Align::kRight).
Key make_key(Canvas& canvas, const Vec2& corner, Align side, const Overlay& overlay, const ChainScale& chains);
void draw_key(Canvas& canvas, const Key& key, bool is_over_mill);  // there, on a plate

}  // namespace tumble::render
