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
  if (!(style.slow > 0)) throw InputError("slow", fmt::format("{} must be above 0", style.slow));
  return style;
}

const Theme& theme_of(const Style& style) { return style.theme == ThemeName::kLight ? light_theme() : dark_theme(); }

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
        context(style.width, style.height),
        scale(first_scale(run, style)) {
    const CurrentContext current(context);
    canvas = std::make_unique<Canvas>(style.width, style.height,
                                      make_layout(style.width, style.height, shape, style.overlay.text, style.mirror),
                                      theme);
    coming = std::make_unique<StillLayer>(style.width, style.height);
    been = std::make_unique<StillLayer>(style.width, style.height);
    glViewport(0, 0, style.width, style.height);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours are premultiplied
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_DITHER);
  }

  void flush() {
    canvas->meshes.flush();
    canvas->discs.flush();
    canvas->text.flush();
  }
  Panel panel() const { return {setup, trace, plot, scale, style.slow}; }
  double trail_seconds() const { return 1.2 * natural_time(); }
  double arrow_seconds() const { return 0.11 * natural_time(); }
  double natural_time() const { return std::sqrt(shape.radius / kGravity); }  // of a fall in this mill [s]

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
  std::unique_ptr<Canvas> canvas;
  std::unique_ptr<StillLayer> coming, been;  // with the torque's curve pale, and bright
};

void Renderer::Impl::paint_still(StillLayer& layer, bool pale) {
  const auto share = [](std::uint8_t channel) { return static_cast<float>(channel) / 255.0f; };
  glClearColor(share(canvas->theme.ground.r), share(canvas->theme.ground.g), share(canvas->theme.ground.b), 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  draw_shell(*canvas, shape);
  if (style.overlay.text) {
    draw_rotation(*canvas, shape, setup.mill_speed);
    const bool arrows = style.overlay.velocity || style.overlay.mean_velocity;
    draw_scale_bar(*canvas, shape, arrows ? arrow_seconds() : kNotGiven);
    draw_key(*canvas, style.overlay, chain_scale(*canvas, setup.balls, widest_chain));
    draw_still_panel(*canvas, panel(), pale);
  }
  flush();
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
  draw_rim_marks(*canvas, shape, marks);
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
  ColourScale& scale = impl_->scale;
  if (scale.by != Colour::kSpin && scale.by != Colour::kSize) {
    scale.low = low;
    scale.high = high;
  } else if (scale.by == Colour::kSpin) {  // pale is zero
    scale.high = std::max(std::abs(low), std::abs(high));
    scale.low = -scale.high;
  }
  impl_->is_painted = false;
}

void Renderer::set_mean(const ChargeMotion& motion) {
  impl_->mean = make_mean_view(motion, impl_->style.overlay, 1 / impl_->canvas->layout.camera.pixels_per_metre);
}

void Renderer::set_force_scale(double high) {
  impl_->widest_chain = high;
  impl_->is_painted = false;
}

double Renderer::trail_seconds() const { return impl_->trail_seconds(); }

const Image& Renderer::draw(const Frame& frame, const Moment& moment) {
  Impl& my = *impl_;
  const Overlay& overlay = my.style.overlay;
  {
    const CurrentContext current(my.context);
    Canvas& canvas = *my.canvas;
    my.paint_still_layers(moment);
    my.coming->restore();
    if (overlay.text && my.plot) {
      const Box& box = my.plot->box;
      my.been->restore({box.left, box.top, std::min(my.plot->x_of(frame.time), box.right), box.bottom});
    }
    draw_lifters(canvas, my.shape, frame.mill_angle);
    const ChargeView charge{my.setup.balls, frame, moment.of_ball, my.scale};
    if (overlay.tracks) draw_trails(canvas, charge, moment.past, my.trail_seconds());
    canvas.meshes.flush();
    draw_balls(canvas, charge);
    canvas.discs.flush();
    if (overlay.chains)
      draw_chains(canvas, frame, moment.contacts, chain_scale(canvas, my.setup.balls, my.widest_chain));
    draw_mean(canvas, my.shape, my.mean, overlay, my.arrow_seconds());
    if (overlay.velocity) draw_velocities(canvas, my.setup.balls, frame, my.arrow_seconds());
    my.draw_rim(moment);
    if (overlay.text) draw_moving_panel(canvas, my.panel(), frame);
    my.flush();
  }
  return my.context.image();
}

}  // namespace tumble::render
