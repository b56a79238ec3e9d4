#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/mill_shape.h"
#include "core/units.h"
#include "render/camera.h"
#include "render/canvas.h"
#include "render/charge_view.h"
#include "render/marks.h"
#include "render/mill_view.h"
#include "render/offscreen_context.h"
#include "render/panel.h"

namespace tumble::render {
namespace {

constexpr int kSmallestSize = 64, kLargestSize = 8192;  // [px]

const Style& checked(const Style& style) {
  const auto fits = [](int size) { return size >= kSmallestSize && size <= kLargestSize && size % 2 == 0; };
  if (!fits(style.width) || !fits(style.height)) {
    throw InputError("size", fmt::format("{}x{} cannot be a picture; width and height must be even and from {} to {}",
                                         style.width, style.height, kSmallestSize, kLargestSize));
  }
  if (!(style.slow > 0)) throw InputError("slow", fmt::format("{} must be above 0", style.slow));
  return style;
}

// Where a colour scale ends as long as nobody has seen the whole run: the speed of a fall through one mill radius,
// the spin of the smallest ball rolling on the shell.
ColourScale first_scale(const RunSetup& setup, const Style& style) {
  const double radius = setup.config.mill.diameter / 2;
  ColourScale scale{style.colour, 0, std::sqrt(2 * kGravity * radius)};
  const auto& radii = setup.balls.radius;
  if (radii.empty()) return scale;
  const auto [smallest, largest] = std::minmax_element(radii.begin(), radii.end());
  if (style.colour == Colour::kSize) {
    scale.low = *smallest;
    scale.high = *largest;
  } else if (style.colour == Colour::kSpin) {
    scale.high = std::max(1.0, std::abs(setup.mill_speed) * radius / *smallest);
    scale.low = -scale.high;
  }
  return scale;
}

}  // namespace

struct Renderer::Impl {
  Impl(const RunSetup& run, const Style& wanted)
      : setup(run),
        style(checked(wanted)),
        shape(make_mill_shape(run.config.mill)),
        context(style.width, style.height),
        scale(first_scale(run, style)) {
    const CurrentContext current(context);
    canvas = std::make_unique<Canvas>(style.width, style.height,
                                      make_layout(style.width, style.height, shape, style.overlay.text, style.mirror));
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours are premultiplied
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_DITHER);
  }

  RunSetup setup;
  Style style;
  MillShape shape;
  OffscreenContext context;
  ColourScale scale;
  std::unique_ptr<Canvas> canvas;
};

Renderer::Renderer(const RunSetup& setup, const Style& style) : impl_(std::make_unique<Impl>(setup, style)) {}
Renderer::~Renderer() = default;

void Renderer::set_scale(double low, double high) {
  impl_->scale.low = low;
  impl_->scale.high = high;
}

const Image& Renderer::draw(const Frame& frame, const Moment& moment) {
  Impl& my = *impl_;
  const Overlay& overlay = my.style.overlay;
  const double natural_time = std::sqrt(my.shape.radius / kGravity);  // of a fall in this mill [s]
  {
    const CurrentContext current(my.context);
    Canvas& canvas = *my.canvas;
    const Rgba ground = ink::kGround;
    glViewport(0, 0, my.style.width, my.style.height);
    glClearColor(static_cast<float>(ground.r) / 255.0f, static_cast<float>(ground.g) / 255.0f,
                 static_cast<float>(ground.b) / 255.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);

    draw_mill(canvas, my.shape, frame.mill_angle);
    if (overlay.tracks) draw_trails(canvas, my.setup.balls, frame, moment.past, 1.2 * natural_time, my.scale);
    draw_balls(canvas, my.setup.balls, frame, my.scale);
    const double arrow_seconds = 0.11 * natural_time;
    if (overlay.velocity) draw_velocities(canvas, my.setup.balls, frame, arrow_seconds);

    draw_toe_and_shoulder(canvas, my.shape, overlay.toe ? moment.toe_deg : kNotGiven,
                          overlay.shoulder ? moment.shoulder_deg : kNotGiven);
    if (overlay.text) {
      draw_rotation(canvas, my.shape, my.setup.mill_speed);
      draw_scale_bar(canvas, my.shape, overlay.velocity ? arrow_seconds : kNotGiven);
      // The running mean is taken over one lifter passage; a smooth shell has none, and gets an 18th of a revolution.
      const int passages = my.shape.lifter_count > 0 ? my.shape.lifter_count : 18;
      const double passage = my.setup.mill_speed == 0 ? 0 : 2 * kPi / (std::abs(my.setup.mill_speed) * passages);
      const TorqueTrace trace{moment.torque_time, moment.torque, passage, frame.time};
      draw_panel(canvas, my.setup, frame, trace, my.scale, my.style.slow);
    }
    canvas.meshes.flush();
    canvas.discs.flush();
    canvas.text.flush();
  }
  return my.context.image();
}

}  // namespace tumble::render
