#pragma once
#include "core/mill_shape.h"
#include "render/canvas.h"

namespace tumble::render {

// What stands still in the picture: the inside and the round steel, which looks the same at any angle.
void draw_shell(Canvas& canvas, const MillShape& shape);

// What turns: lifters and bolts, at the mill angle [rad].
void draw_lifters(Canvas& canvas, const MillShape& shape, double mill_angle);

}  // namespace tumble::render
