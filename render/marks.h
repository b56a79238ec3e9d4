#pragma once
#include "core/mill_shape.h"
#include "render/canvas.h"

namespace tumble::render {

// Toe and shoulder outside the rim, as the literature draws them: a pointer and its angle each, and an arc over the
// charge between them. Nothing is drawn over the charge. Angles in degrees, NaN = no mark.
void draw_toe_and_shoulder(Canvas& canvas, const MillShape& shape, double toe_deg, double shoulder_deg);

// A curved arrow that shows which way the mill turns; nothing for a mill that stands still. speed in [rad/s].
void draw_rotation(Canvas& canvas, const MillShape& shape, double speed);

// A bar of a round length in the lower left corner, with the key of the velocity arrows (seconds of motion an arrow
// is long) when those are drawn; NaN without them.
void draw_scale_bar(Canvas& canvas, const MillShape& shape, double arrow_seconds);

}  // namespace tumble::render
