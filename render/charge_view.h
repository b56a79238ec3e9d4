#pragma once
#include <functional>
#include <span>

#include "core/frame.h"
#include "render/canvas.h"
#include "render/renderer.h"

namespace tumble::render {

// What a ball's colour stands for, and where the scale begins and ends.
struct ColourScale {
  Colour by = Colour::kSpeed;
  double low = 0, high = 1;               // [m/s], [rad/s] or, by size, the radii [m]
  void set_ends(double from, double to);  // Renderer::set_scale
  Rgba colour_of(double value) const;
  const Palette& palette() const;
};

// The quantity that colours ball i of a frame; NaN by Colour::kSteel.
double coloured_value(Colour by, const Balls& balls, const Frame& frame, std::size_t i);

void draw_balls(Canvas& canvas, const Balls& balls, const Frame& frame, const ColourScale& scale);

// Paths of the last `seconds` as `camera_then` sees each moment of them, fading into the past.
void draw_trails(Canvas& canvas, const Balls& balls, const Frame& frame, std::span<const Frame> past, double seconds,
                 const ColourScale& scale, const std::function<Camera(const Frame&)>& camera_then);

// One arrow a ball, `seconds` of its motion in the picture's frame long.
void draw_velocities(Canvas& canvas, const Balls& balls, const Frame& frame, double seconds);

// A ring round the ball that the camera follows, and its number.
void draw_followed(Canvas& canvas, const Balls& balls, const Frame& frame, std::size_t ball);

// An arrow from `a` to `b`, outlined so that it reads on any ground; nothing where it would be a dot.
void draw_arrow(Canvas& canvas, const Vec2& a, const Vec2& b, double width, Rgba colour);

}  // namespace tumble::render
