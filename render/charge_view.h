#pragma once
#include <algorithm>
#include <functional>
#include <span>

#include "core/contact_force.h"
#include "core/frame.h"
#include "render/canvas.h"
#include "render/renderer.h"

namespace tumble::render {

// What a ball's colour stands for, and where the scale begins and ends.
struct ColourScale {
  Colour by = Colour::kSpeed;
  double low = 0, high = 1;  // [m/s], [rad/s], [s], [N] or, by size, the radii [m]
  const Theme* theme = &dark_theme();
  void set_ends(double from, double to);  // Renderer::set_scale
  Rgba colour_of(double value) const;
  const Palette& palette() const;
};

// What is looked at of the charge.
struct ChargeView {
  const Balls& balls;
  const Frame& frame;
  std::span<const double> of_ball;  // of the frame, where no frame holds what colours the balls (Moment)
  const ColourScale& scale;
};

void draw_balls(Canvas& canvas, const ChargeView& charge);

// Paths of the last `seconds` as `camera_then` sees each moment of them, fading into the past.
void draw_trails(Canvas& canvas, const ChargeView& charge, std::span<const Frame> past, double seconds,
                 const std::function<Camera(const Frame&)>& camera_then);

// One arrow a ball, `seconds` of its motion in the picture's frame long.
void draw_velocities(Canvas& canvas, const Balls& balls, const Frame& frame, double seconds);

// A ring round the ball that the camera follows, and its number.
void draw_followed(Canvas& canvas, const Balls& balls, const Frame& frame, std::size_t ball);

// How wide a force is drawn: in proportion, up to the widest.
struct ChainScale {
  double force = 1, width = 1;  // of the widest line [N], [px]
  double share_of(double normal) const { return std::clamp(normal / force, 0.0, 1.0); }
};
ChainScale chain_scale(const Canvas& canvas, const Balls& balls, double widest_force);

// Lines from ball to touching ball, and to the shell, as wide and as bright as the normal force.
void draw_chains(Canvas& canvas, const Frame& frame, std::span<const ContactForce> contacts, const ChainScale& scale);

// An arrow from `a` to `b`, outlined so that it reads on any ground; nothing where it would be a dot.
void draw_arrow(Canvas& canvas, const Vec2& a, const Vec2& b, double width, Rgba colour);

}  // namespace tumble::render
