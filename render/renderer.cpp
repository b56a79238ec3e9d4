#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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
#include "render/still_layer.h"

namespace tumble::render {
namespace {

constexpr int kSmallestSize = 64, kLargestSize = 8192;  // [px]

const Style& checked(const Style& style) {
  const auto fits = [](int size) { return size >= kSmallestSize && size <= kLargestSize && size % 2 == 0; };
  if (!fits(style.width) || !fits(style.height)) {
    throw InputError("size", fmt::format("{}x{} cannot be a picture; width and height must be even and from {} to {}",
                                         style.width, style.height, kSmallestSize, kLargestSize));
  }
  if (style.slow <= 0) throw InputError("slow", fmt::format("{} must be above 0", style.slow));
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
        shape(make_mill_shape(run.config)),
        context(style.width, style.height, style.context),
        scale(first_scale(run, style)) {
    const CurrentContext current(context);
    canvas = std::make_unique<Canvas>(
        style.width, style.height,
        make_layout(style.width, style.height, shape, style.overlay.text, style.mirror, style.view.zoom));
    layout = canvas->layout;
    coming = std::make_unique<StillLayer>(style.width, style.height);
    been = std::make_unique<StillLayer>(style.width, style.height);
  }

  Panel panel() const { return {setup, trace, plot, scale, style.slow}; }
  double trail_seconds() const { return 1.2 * natural_time(); }
  double arrow_seconds() const { return 0.11 * natural_time(); }
  double natural_time() const { return std::sqrt(shape.radius / kGravity); }  // of a fall in this mill [s]

  void draw_scale();

  Box past_of_plot(const Frame& frame) const {
    return {plot->box.left, plot->box.top, std::min(plot->x_of(frame.time), plot->box.right), plot->box.bottom};
  }

  void draw_still(bool pale);
  void draw_moving(const Frame& frame, const Moment& moment);
  void paint_still(StillLayer& layer, bool pale);
  void paint_still_layers(const Moment& moment);

  RunSetup setup;
  Style style;
  MillShape shape;
  OffscreenContext context;
  ColourScale scale;
  TorqueTrace trace;
  std::optional<TorquePlot> plot;
  bool is_painted = false;  // the still layers, for the scale and trace above
  Layout layout;            // the canvas' own, but for the camera of the frame
  std::unique_ptr<Canvas> canvas;
  std::unique_ptr<StillLayer> coming, been;  // with the torque's curve pale, and bright
};

void Renderer::Impl::draw_scale() {
  const bool is_over_mill = style.view.is_cut();
  const Box& box = is_over_mill ? layout.view : layout.picture;
  draw_scale_bar(*canvas, {box.left + canvas->px(28), box.bottom - canvas->px(30)}, shape.radius,
                 style.overlay.velocity ? arrow_seconds() : kNotGiven, is_over_mill);
}

void Renderer::Impl::draw_still(bool pale) {
  canvas->layout.camera = layout.camera;
  if (!style.view.is_cut()) draw_shell(*canvas, shape);
  if (style.overlay.text) {
    if (style.view.from == View::From::kLab && !style.view.is_cut()) draw_rotation(*canvas, shape, setup.mill_speed);
    if (!style.view.is_cut()) draw_scale();
    draw_still_panel(*canvas, panel(), pale);
  }
  canvas->flush();
}

void Renderer::Impl::paint_still(StillLayer& layer, bool pale) {
  canvas->paint_ground();
  draw_still(pale);
  layer.capture();
}

void Renderer::Impl::paint_still_layers(const Moment& moment) {
  if (is_painted && trace.is_of(moment.torque_time, moment.torque)) return;
  // The running mean is taken over one lifter passage; a smooth shell has none, and gets an 18th of a revolution.
  const int passages = shape.lifter_count > 0 ? shape.lifter_count : 18;
  const double passage = setup.mill_speed == 0 ? 0 : 2 * kPi / (std::abs(setup.mill_speed) * passages);
  trace = TorqueTrace(moment.torque_time, moment.torque, passage);
  plot = place_torque_plot(*canvas, trace, style.colour);
  if (plot) paint_still(*been, false);
  paint_still(*coming, true);
  is_painted = true;
}

Renderer::Renderer(const RunSetup& setup, const Style& style) : impl_(std::make_unique<Impl>(setup, style)) {}
Renderer::~Renderer() = default;

void Renderer::set_scale(double low, double high) {
  impl_->scale.set_ends(low, high);
  impl_->is_painted = false;
}

double Renderer::trail_seconds() const { return impl_->trail_seconds(); }

void Renderer::Impl::draw_moving(const Frame& frame, const Moment& moment) {
  const Overlay& overlay = style.overlay;
  const View& view = style.view;
  const Camera camera = camera_of(layout, view, frame, setup.mill_speed);
  // Trails are paths in the laboratory, or against the shell; against a ball they would lead through the steel.
  const auto camera_then = [&](const Frame& then) {
    return view.from == View::From::kShell ? camera_of(layout, view, then, setup.mill_speed) : camera;
  };
  canvas->layout.camera = camera;
  if (view.is_cut()) {
    canvas->clip(layout.view);
    draw_shell(*canvas, shape);
  }
  draw_lifters(*canvas, shape, frame.mill_angle);
  if (overlay.tracks) draw_trails(*canvas, setup.balls, frame, moment.past, trail_seconds(), scale, camera_then);
  canvas->meshes.flush();
  draw_balls(*canvas, setup.balls, frame, scale);
  canvas->discs.flush();
  if (overlay.velocity) draw_velocities(*canvas, setup.balls, frame, arrow_seconds());
  draw_toe_and_shoulder(*canvas, shape, overlay.toe ? moment.toe_deg : kNotGiven,
                        overlay.shoulder ? moment.shoulder_deg : kNotGiven);
  if (view.from == View::From::kBall) draw_followed(*canvas, setup.balls, frame, view.ball);
  if (view.from == View::From::kShell) draw_gravity(*canvas);
  if (view.is_cut()) {
    if (overlay.text) draw_scale();
    canvas->flush();
    canvas->unclip();
  }
  if (overlay.text) draw_moving_panel(*canvas, panel(), frame);
  canvas->flush();
}

const Image& Renderer::draw(const Frame& frame, const Moment& moment) {
  Impl& my = *impl_;
  {
    const CurrentContext current(my.context);
    my.paint_still_layers(moment);
    my.coming->restore();
    if (my.style.overlay.text && my.plot) my.been->restore(my.past_of_plot(frame));
    my.draw_moving(frame, moment);
  }
  return my.context.image();
}

Drawing Renderer::sketch(const Frame& frame, const Moment& moment) {
  Impl& my = *impl_;
  Drawing drawing{my.style.width, my.style.height, ink::kGround, {}};
  const CurrentContext current(my.context);
  my.paint_still_layers(moment);
  Canvas& canvas = *my.canvas;
  canvas.record_into(&drawing);
  my.draw_still(true);
  if (my.style.overlay.text && my.plot) {
    const Box past = my.past_of_plot(frame);
    canvas.clip(past);
    canvas.meshes.rectangle(past.left, past.top, past.right, past.bottom, ink::kGround);
    my.draw_still(false);
    canvas.unclip();
  }
  my.draw_moving(frame, moment);
  canvas.record_into(nullptr);
  return drawing;
}

}  // namespace tumble::render
