#pragma once
#include "core/mill_shape.h"
#include "render/canvas.h"

namespace tumble::render {

// Toe and shoulder outside the rim, as the literature draws them: a pointer and its angle each, and an arc over the
// charge between them. Nothing is drawn over the charge. Angles in degrees, NaN = no mark.
void draw_toe_and_shoulder(Canvas& canvas, const MillShape& shape, double toe_deg, double shoulder_deg);

// A curved arrow that shows which way the mill turns; nothing for a mill that stands still. speed in [rad/s].
void draw_rotation(Canvas& canvas, const MillShape& shape, double speed);

// Which way is down, in a corner of a view that turns.
void draw_gravity(Canvas& canvas);

// A bar of a round length from `left_end` on [px], with the key of the velocity arrows (seconds of motion an arrow
// is long) when those are drawn, NaN without them; on a plate where it lies over the mill. Shell's radius in [m].
void draw_scale_bar(Canvas& canvas, const Vec2& left_end, double shell_radius, double arrow_seconds,
                    bool is_over_mill = false);

}  // namespace tumble::render
