#include "render/charge_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::render {
namespace {

constexpr double kMarkFadeFrom = 6.0, kMarkFadeTo = 4.0;  // ball radii between which marks fade away [px]
constexpr std::size_t kTrailPoints = 24;                  // corners of one trail, whatever the frame rate

}  // namespace

const Palette& ColourScale::palette() const { return by == Colour::kSpin ? diverging_palette() : sequential_palette(); }

void ColourScale::set_ends(double from, double to) {
  if (by == Colour::kSpin) {  // pale is zero
    high = std::max(std::abs(from), std::abs(to));
    low = -high;
  } else if (by != Colour::kSteel) {
    low = from;
    high = to;
  }
}

Rgba ColourScale::colour_of(double value) const {
  if (by == Colour::kSteel || std::isnan(value)) return ink::kSteel;
  if (!(high > low)) return palette().at(0.5);
  return palette().at((value - low) / (high - low));
}

double coloured_value(Colour by, const Balls& balls, const Frame& frame, std::size_t i) {
  switch (by) {
    case Colour::kSpeed:
      return std::hypot(frame.vx[i], frame.vy[i]);
    case Colour::kSize:
      return balls.radius[i];
    case Colour::kSpin:
      return frame.spin[i];
    case Colour::kSteel:
      break;
  }
  return kNotGiven;
}

void draw_balls(Canvas& canvas, const Balls& balls, const Frame& frame, const ColourScale& scale) {
  const Camera& camera = canvas.layout.camera;
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    Disc disc;
    disc.centre = camera.image_from_mill(frame.x[i], frame.y[i]);
    disc.radius = balls.radius[i] * camera.pixels_per_metre;
    disc.colour = scale.colour_of(coloured_value(scale.by, balls, frame, i));
    disc.mark = camera.direction(frame.angle[i]);
    disc.mark_strength = 0.85 * std::clamp((disc.radius - kMarkFadeTo) / (kMarkFadeFrom - kMarkFadeTo), 0.0, 1.0);
    disc.gloss = scale.by == Colour::kSteel ? 1.0 : 0.35;
    canvas.discs.add(disc);
  }
}

void draw_trails(Canvas& canvas, const Balls& balls, const Frame& frame, std::span<const Frame> past, double seconds,
                 const ColourScale& scale, const std::function<Camera(const Frame&)>& camera_then) {
  const Camera& camera = canvas.layout.camera;
  std::size_t first = past.size();
  while (first > 0 && past[first - 1].time > frame.time - seconds) --first;
  const auto recent = past.subspan(first);
  if (recent.empty()) return;
  const std::size_t stride = (recent.size() + kTrailPoints - 1) / kTrailPoints;
  std::vector<Camera> cameras;
  for (std::size_t k = 0; k < recent.size(); k += stride) cameras.push_back(camera_then(recent[recent.size() - 1 - k]));
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    const double widest = std::clamp(0.34 * balls.radius[i] * camera.pixels_per_metre, 0.5, canvas.px(3.2));
    Vec2 to = camera.image_from_mill(frame.x[i], frame.y[i]);
    // Backwards in time, in steps counted from the newest, so that a trail glides instead of jumping.
    for (std::size_t k = 0; k < recent.size(); k += stride) {
      const Frame& then = recent[recent.size() - 1 - k];
      if (then.x.size() != frame.x.size()) break;
      const double age = (frame.time - then.time) / seconds;
      const Vec2 from = cameras[k / stride].image_from_mill(then.x[i], then.y[i]);
      const Rgba colour = scale.colour_of(coloured_value(scale.by, balls, then, i));
      canvas.meshes.line(from, to, widest * (1 - 0.6 * age), with_alpha(colour, 0.75 * std::max(0.0, 1 - age)));
      to = from;
    }
  }
}

void draw_followed(Canvas& canvas, const Balls& balls, const Frame& frame, std::size_t ball) {
  const Camera& camera = canvas.layout.camera;
  const double inner = balls.radius[ball] * camera.pixels_per_metre + canvas.px(2);
  canvas.meshes.ring(camera.image_from_mill(frame.x[ball], frame.y[ball]), inner, inner + canvas.stroke(2.4), 0,
                     2 * kPi, ink::kAccent);
  const Vec2 beside = camera.image_from_mill(frame.x[ball], frame.y[ball]) +
                      Vec2(0.75 * inner + canvas.px(4), -0.75 * inner - canvas.px(4));
  canvas.text.add(fmt::format("ball {}", ball), beside.x(), beside.y(), {canvas.letter(12.5), ink::kAccent});
}

void draw_arrow(Canvas& canvas, const Vec2& a, const Vec2& b, double width, Rgba colour) {
  const double length = (b - a).norm();
  if (length < 2 * width) return;
  const Vec2 along = (b - a) / length, side(-along.y(), along.x());
  const double head = std::min(4.2 * width, 0.6 * length), half = 0.55 * head;
  const auto shape = [&](double grow, Rgba ink) {
    const Vec2 neck = b - head * along;
    canvas.meshes.line(a - grow * along, neck, width + 2 * grow, ink);
    const Vec2 corners[] = {b + 1.8 * grow * along, neck - side * (half + grow) - grow * along,
                            neck + side * (half + grow) - grow * along};
    canvas.meshes.convex(corners, ink);
  };
  shape(canvas.stroke(1.0), with_alpha({8, 10, 13}, 0.65));
  shape(0.0, colour);
}

void draw_velocities(Canvas& canvas, const Balls& balls, const Frame& frame, double seconds) {
  const Camera& camera = canvas.layout.camera;
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    const double radius = balls.radius[i] * camera.pixels_per_metre;
    const Vec2 from = camera.image_from_mill(frame.x[i], frame.y[i]);
    const double vx = frame.vx[i] + camera.turning * frame.y[i], vy = frame.vy[i] - camera.turning * frame.x[i];
    const Vec2 to = camera.image_from_mill(frame.x[i] + seconds * vx, frame.y[i] + seconds * vy);
    draw_arrow(canvas, from, to, std::clamp(0.13 * radius, 0.7, canvas.px(2.0)), ink::kText);
  }
}

}  // namespace tumble::render
