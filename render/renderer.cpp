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
#include "render/mean_view.h"
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
  ColourScale scale{style.colour, 0, std::sqrt(2 * kGravity * radius), &theme_of(style)};
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
        theme(theme_of(style)),
        context(style.width, style.height, style.context),
        scale(first_scale(run, style)) {
    const CurrentContext current(context);
    canvas = std::make_unique<Canvas>(
        style.width, style.height,
        make_layout(style.width, style.height, shape, style.overlay.text, style.mirror, style.view.zoom), theme);
    layout = canvas->layout;
    coming = std::make_unique<StillLayer>(style.width, style.height);
    been = std::make_unique<StillLayer>(style.width, style.height);
  }

  Panel panel() const { return {setup, trace, plot, scale, style.slow}; }
  double trail_seconds() const { return 1.2 * natural_time(); }
  double arrow_seconds() const { return 0.11 * natural_time(); }
  double natural_time() const { return std::sqrt(shape.radius / kGravity); }  // of a fall in this mill [s]

  Box notes() const;  // at whose corners scale and key stand: near the mill, and inside what is shown
  void draw_scale_and_key();
  Key key();

  Box past_of_plot(const Frame& frame) const {
    return {plot->box.left, plot->box.top, std::min(plot->x_of(frame.time), plot->box.right), plot->box.bottom};
  }

  void draw_still(bool pale);
  void draw_moving(const Frame& frame, const Moment& moment);
  void paint_still(StillLayer& layer, bool pale);
  void paint_still_layers(const Moment& moment);
  void draw_rim(const Moment& moment);

  RunSetup setup;
  Style style;
  MillShape shape;
  const Theme& theme;
  OffscreenContext context;
  ColourScale scale;
  double widest_chain = 1;  // [N]
  MeanView mean;
  TorqueTrace trace;
  std::optional<TorquePlot> plot;
  bool is_painted = false;  // the still layers, for the scale and trace above
  Layout layout;            // the canvas' own, but for the camera of the frame
  std::unique_ptr<Canvas> canvas;
  std::unique_ptr<StillLayer> coming, been;  // with the torque's curve pale, and bright
};

Box Renderer::Impl::notes() const {
  const auto px = [this](double units) { return canvas->px(units); };
  const Box& box = style.view.is_cut() ? layout.view : layout.picture;
  Box notes{box.left + px(28), box.top + px(34), layout.view.right - px(28), box.bottom - px(30)};
  if (style.view.is_cut()) return notes;
  notes.left = std::max(notes.left, layout.camera.centre_u - px(372));
  notes.top = std::max(notes.top, layout.camera.centre_v - px(326));
  notes.bottom = std::min(notes.bottom, layout.camera.centre_v + px(330));
  return notes;
}

void Renderer::Impl::draw_scale_and_key() {
  const bool is_over_mill = style.view.is_cut(), has_arrows = style.overlay.velocity || style.overlay.mean_velocity;
  const Box box = notes();
  draw_scale_bar(*canvas, {box.left, box.bottom}, shape.radius, has_arrows ? arrow_seconds() : kNotGiven, is_over_mill);
  draw_key(*canvas, key(), is_over_mill);
}

Key Renderer::Impl::key() {
  if (!style.overlay.text) return {};
  const Box box = notes();
  // The upper left corner of a view that turns says where down is.
  const Align side = style.view.from == View::From::kShell ? Align::kRight : Align::kLeft;
  return make_key(*canvas, {side == Align::kRight ? box.right : box.left, box.top}, side, style.overlay,
                  chain_scale(*canvas, setup.balls, widest_chain));
}

void Renderer::Impl::draw_still(bool pale) {
  canvas->layout.camera = layout.camera;
  if (!style.view.is_cut()) draw_shell(*canvas, shape);
  if (style.overlay.text) {
    if (style.view.from == View::From::kLab && !style.view.is_cut()) draw_rotation(*canvas, shape, setup.mill_speed);
    if (!style.view.is_cut()) draw_scale_and_key();
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

void Renderer::Impl::draw_rim(const Moment& moment) {
  const Overlay& shown = style.overlay;
  const auto angle = [](bool wanted, double value) { return wanted ? value : kNotGiven; };
  const double toe = angle(shown.toe, moment.toe_deg), shoulder = angle(shown.shoulder, moment.shoulder_deg);
  const RimMark marks[] = {{"departure", angle(shown.departure, mean.departure_deg), theme.second},
                           {"impact", angle(shown.impact, mean.impact_toe_deg), theme.second},
                           {"toe", toe, theme.accent},
                           {"shoulder", shoulder, theme.accent}};
  draw_charge_arc(*canvas, shape, toe, shoulder);
  draw_rim_marks(*canvas, shape, marks, key().box);
}

bool shows_mean(const Overlay& o) {
  return o.occupancy || o.streamlines || o.mean_velocity || o.surface || o.head || o.circulation || o.departure ||
         o.impact;
}
bool shows_forces(const Style& style) { return style.overlay.chains || style.colour == Colour::kForce; }
bool shows_residence(const Style& style) { return style.colour == Colour::kResidence; }

Renderer::Renderer(const RunSetup& setup, const Style& style) : impl_(std::make_unique<Impl>(setup, style)) {}
Renderer::~Renderer() = default;

void Renderer::set_scale(double low, double high) {
  impl_->scale.set_ends(low, high);
  impl_->is_painted = false;
}

void Renderer::set_mean(const ChargeMotion& motion) {
  impl_->mean = make_mean_view(motion, impl_->style.overlay, 1 / impl_->layout.camera.pixels_per_metre);
}

void Renderer::set_force_scale(double high) {
  impl_->widest_chain = high;
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
  const ChargeView charge{setup.balls, frame, moment.of_ball, scale};
  if (overlay.tracks) draw_trails(*canvas, charge, moment.past, trail_seconds(), camera_then);
  canvas->meshes.flush();
  draw_balls(*canvas, charge);
  canvas->discs.flush();
  if (overlay.chains) draw_chains(*canvas, frame, moment.contacts, chain_scale(*canvas, setup.balls, widest_chain));
  draw_mean(*canvas, shape, mean, overlay, arrow_seconds());
  if (overlay.velocity) draw_velocities(*canvas, setup.balls, frame, arrow_seconds());
  draw_rim(moment);
  if (view.from == View::From::kBall) draw_followed(*canvas, setup.balls, frame, view.ball);
  if (view.from == View::From::kShell) draw_gravity(*canvas);
  if (view.is_cut()) {
    if (overlay.text) draw_scale_and_key();
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
  Drawing drawing{my.style.width, my.style.height, my.theme.ground, {}};
  const CurrentContext current(my.context);
  my.paint_still_layers(moment);
  Canvas& canvas = *my.canvas;
  canvas.record_into(&drawing);
  my.draw_still(true);
  if (my.style.overlay.text && my.plot) {
    const Box past = my.past_of_plot(frame);
    canvas.clip(past);
    canvas.meshes.rectangle(past.left, past.top, past.right, past.bottom, my.theme.ground);
    draw_torque_curve(canvas, *my.plot, my.trace, false);
    canvas.flush();
    canvas.unclip();
  }
  my.draw_moving(frame, moment);
  canvas.record_into(nullptr);
  return drawing;
}

}  // namespace tumble::render
