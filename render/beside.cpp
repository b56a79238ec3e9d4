#include "render/beside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/angle.h"
#include "core/mill_shape.h"
#include "render/axis.h"
#include "render/beside_words.h"
#include "render/canvas.h"
#include "render/charge_view.h"
#include "render/coverage_mean.h"
#include "render/marks.h"
#include "render/mill_view.h"
#include "render/offscreen_context.h"
#include "render/picture_quad.h"
#include "render/still_layer.h"

namespace tumble::render {
namespace {

constexpr int kBallCorners = 40;

// Light strokes over a film need a dark edge: steel is as light as they are.
void stroke_over_film(Canvas& canvas, const std::vector<Vec2>& points, double width, Rgba colour) {
  canvas.meshes.polyline(points, width + 2 * canvas.stroke(0.9), with_alpha({8, 10, 13}, 0.55));
  canvas.meshes.polyline(points, width, colour);
}

std::vector<Vec2> closed(std::vector<Vec2> corners) {
  if (!corners.empty()) corners.push_back(corners.front());
  return corners;
}

}  // namespace

struct BesideRenderer::Impl {
  Impl(const RunSetup& run, const BesideStyle& wanted, const BesideWords& told, double film_radius)
      : setup(run),
        style(wanted),
        words(told),
        shape(make_mill_shape(run.config)),
        context(style.width, style.height),
        scale{style.colour, 0, std::sqrt(2 * kGravity * shape.radius)} {
    const CurrentContext current(context);
    canvas = std::make_unique<Canvas>(style.width, style.height,
                                      make_layout(style.width, style.height, shape, true, style.mirror), dark_theme());
    picture = std::make_unique<PictureQuad>(style.width, style.height);
    still = std::make_unique<StillLayer>(style.width, style.height);
    if (style.view == BesideView::kSide)
      canvas->layout.unit = style.width < style.height ? std::min(style.width / 720.0, style.height / 1280.0)
                                                       : std::min(style.width / 1280.0, style.height / 720.0);
    plan.emplace(*canvas, style.view);
    // One scale for both: so many pixels a metre as the film's mill has.
    canvas->layout.camera.pixels_per_metre = 0.5 * plan->edge / (plan->margin * film_radius);
    if (style.view == BesideView::kDifference) coverage.emplace(plan->edge, style.mean_over);
  }

  void look_at(const BesidePlan::Place& square) {  // from here on the mill stands in its middle
    canvas->layout.camera.centre_u = square.left + 0.5 * plan->edge - 0.5;
    canvas->layout.camera.centre_v = square.top + 0.5 * plan->edge - 0.5;
  }
  // Of the film's square, as the film is shown there.
  Vec2 on_film(double x, double y, double behind) const {
    if (style.view != BesideView::kOverlay || !projection.place) return canvas->layout.camera.image_from_mill(x, y);
    return projection.place(x, y, behind) + Vec2(plan->film.left, plan->film.top);
  }

  void paint_still();
  void draw_run(const Frame& frame);
  void draw_over_film(const Frame& frame);
  void draw_edges(const ChargeEdge& of, Rgba colour, double from, double to);
  void draw_surface();
  void name_edges(const ChargeEdge& film, const ChargeEdge& run);
  void draw_wipe(const BesideMoment& moment);
  void add_coverage(const std::vector<FilmedBall>& balls, const Frame& frame);
  void draw_difference(const Frame& frame);

  RunSetup setup;
  BesideStyle style;
  BesideWords words;
  MillShape shape;
  OffscreenContext context;
  ColourScale scale;
  FilmProjection projection;
  std::vector<Vec2> surface;  // of the run [m]
  std::optional<BesidePlan> plan;
  std::optional<CoverageMean> coverage;
  std::unique_ptr<Canvas> canvas;
  std::unique_ptr<PictureQuad> picture;
  std::unique_ptr<StillLayer> still;
  bool is_painted = false;
};

void BesideRenderer::Impl::paint_still() {
  canvas->paint_ground();
  look_at(plan->run);
  if (style.view == BesideView::kSide || style.view == BesideView::kDifference) draw_shell(*canvas, shape);
  // Under the film of two, in the column beside one.
  const Layout& layout = canvas->layout;
  const double left = plan->two ? layout.picture.left + canvas->px(28) : layout.panel.left;
  draw_scale_bar(*canvas, {left, layout.picture.bottom - canvas->px(30)}, shape.radius, kNotGiven);
  draw_still_words(*canvas, *plan, setup, style, words);
  canvas->flush();
  still->capture();
  is_painted = true;
}

void BesideRenderer::Impl::draw_run(const Frame& frame) {
  draw_lifters(*canvas, shape, frame.mill_angle);
  canvas->meshes.flush();
  draw_balls(*canvas, {setup.balls, frame, {}, scale});
  canvas->discs.flush();
}

// The shell's outline and the balls' as the film's camera would see them.
void BesideRenderer::Impl::draw_over_film(const Frame& frame) {
  const double c = std::cos(frame.mill_angle), s = std::sin(frame.mill_angle);
  std::vector<Vec2> steel;
  for (const Vec2& p : outline(shape, 0.02 * shape.radius))
    steel.push_back(on_film(c * p.x() - s * p.y(), s * p.x() + c * p.y(), 0));
  stroke_over_film(*canvas, closed(std::move(steel)), canvas->stroke(1.3), with_alpha(kRunInk, 0.8));
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    std::vector<Vec2> ball;
    if (projection.ball)
      for (const Vec2& p : projection.ball(frame.x[i], frame.y[i], setup.balls.radius[i]))
        ball.push_back(p + Vec2(plan->film.left, plan->film.top));
    if (ball.size() < 3) continue;
    if (style.opacity > 0) canvas->meshes.convex(ball, with_alpha(kRunInk, style.opacity));
    const double radius = setup.balls.radius[i] * canvas->layout.camera.pixels_per_metre;
    stroke_over_film(*canvas, closed(std::move(ball)), std::clamp(0.14 * radius, 0.7, canvas->px(1.7)), kRunInk);
  }
  canvas->meshes.flush();
}

// Across the rim: the film's mark its outer half, the run's its inner, so that none hides the other.
void BesideRenderer::Impl::draw_edges(const ChargeEdge& of, Rgba colour, double from, double to) {
  for (const double deg : {of.toe_deg, of.shoulder_deg}) {
    if (std::isnan(deg)) continue;
    const double a = radians(deg), r = shape.radius;
    stroke_over_film(*canvas,
                     {on_film(from * r * std::cos(a), from * r * std::sin(a), 0),
                      on_film(to * r * std::cos(a), to * r * std::sin(a), 0)},
                     canvas->stroke(4.6), colour);
  }
}

void BesideRenderer::Impl::draw_surface() {
  std::vector<Vec2> line;
  for (const Vec2& p : surface) line.push_back(on_film(p.x(), p.y(), 0));
  if (line.size() > 1) stroke_over_film(*canvas, line, canvas->stroke(2.6), kRunInk);
}

void BesideRenderer::Impl::name_edges(const ChargeEdge& film, const ChargeEdge& run) {
  const std::pair<const char*, double> names[] = {
      {"toe", std::isnan(film.toe_deg) ? run.toe_deg : film.toe_deg},
      {"shoulder", std::isnan(film.shoulder_deg) ? run.shoulder_deg : film.shoulder_deg}};
  const TextStyle word{canvas->letter(12.5), canvas->theme.text, Weight::kBold, Align::kCentre};
  const double half = 0.5 * plan->edge, left = canvas->layout.camera.centre_u - half,
               top = canvas->layout.camera.centre_v - half;
  for (const auto& [name, deg] : names) {
    if (std::isnan(deg)) continue;
    const double a = radians(deg), r = 1.11 * shape.radius;
    const Vec2 out = canvas->layout.camera.direction(a);
    const double width = canvas->text.width(name, word) + canvas->px(8), height = 1.35 * word.size;
    const Vec2 at = on_film(r * std::cos(a), r * std::sin(a), 0) +
                    (0.5 * (std::abs(out.x()) * width + std::abs(out.y()) * height) + canvas->px(3)) * out;
    const double x = std::clamp(at.x(), left + width / 2, left + plan->edge - width / 2);
    const double y = std::clamp(at.y(), top + height / 2, top + plan->edge - height / 2);
    canvas->meshes.rectangle(x - width / 2, y - height / 2, x + width / 2, y + height / 2,
                             with_alpha(canvas->theme.ground, 0.7));
    canvas->text.add(name, x, y + 0.36 * word.size, word);
  }
}

void BesideRenderer::Impl::draw_wipe(const BesideMoment& moment) {
  const double edge = plan->edge, line = plan->film.left - 0.5 + std::clamp(moment.wipe, 0.0, 1.0) * edge;
  const double top = plan->film.top - 0.5, bottom = top + edge;
  const int from = std::clamp(static_cast<int>(std::lround(line + 0.5)), 0, style.width);
  glEnable(GL_SCISSOR_TEST);
  glScissor(from, 0, style.width - from, style.height);
  canvas->meshes.rectangle(line, top, plan->film.left - 0.5 + edge, bottom, canvas->theme.ground);
  draw_shell(*canvas, shape);
  draw_run(*moment.run);
  glDisable(GL_SCISSOR_TEST);
  canvas->meshes.line({line, top}, {line, bottom}, canvas->stroke(3.5), with_alpha(canvas->theme.ground, 0.6));
  canvas->meshes.line({line, top}, {line, bottom}, canvas->stroke(1.6), canvas->theme.text);
  const double gap = canvas->px(9), y = top + canvas->px(20);
  const TextStyle right{canvas->letter(13), kRunInk, Weight::kBold};
  TextStyle left = right;
  left.colour = kFilmInk;
  const auto tag = [&](const char* name, double x, const TextStyle& ink) {
    const double width = canvas->text.width(name, ink), pad = canvas->px(5);
    canvas->meshes.rectangle(x - pad, y - 0.95 * ink.size, x + width + pad, y + 0.35 * ink.size,
                             with_alpha(canvas->theme.ground, 0.75));
    canvas->text.add(name, x, y, ink);
  };
  const double film_width = canvas->text.width("film", left), run_width = canvas->text.width("simulation", right);
  if (line - gap - film_width > plan->film.left) tag("film", line - gap - film_width, left);
  if (line + gap + run_width < plan->film.left + edge) tag("simulation", line + gap, right);
}

void BesideRenderer::Impl::add_coverage(const std::vector<FilmedBall>& balls, const Frame& frame) {
  look_at(plan->film);
  const Camera& camera = canvas->layout.camera;
  const Vec2 corner(plan->film.left, plan->film.top);
  const auto disc = [&](double x, double y, double radius) {
    const Vec2 at = camera.image_from_mill(x, y) - corner;
    return CoveredDisc{at.x(), at.y(), radius * camera.pixels_per_metre};
  };
  std::vector<CoveredDisc> film, run;
  for (const FilmedBall& b : balls) film.push_back(disc(b.x, b.y, b.radius));
  for (std::size_t i = 0; i < frame.x.size(); ++i) run.push_back(disc(frame.x[i], frame.y[i], setup.balls.radius[i]));
  coverage->add(film, run);
}

void BesideRenderer::Impl::draw_difference(const Frame& frame) {
  picture->draw(coverage->picture(kFilmInk, kRunInk, scaled(canvas->theme.steel, 0.62)), plan->film.left,
                plan->film.top);
  draw_lifters(*canvas, shape, frame.mill_angle);
  canvas->meshes.flush();
}

BesideRenderer::BesideRenderer(const RunSetup& setup, const BesideStyle& style, const BesideWords& words, double radius)
    : impl_(std::make_unique<Impl>(setup, style, words, radius)) {}
BesideRenderer::~BesideRenderer() = default;

FilmSquare BesideRenderer::square() const { return {impl_->plan->edge, impl_->plan->margin}; }
void BesideRenderer::set_projection(FilmProjection projection) { impl_->projection = std::move(projection); }

void BesideRenderer::set_surface(std::vector<Vec2> run) { impl_->surface = std::move(run); }

void BesideRenderer::set_scale(double low, double high) { impl_->scale.set_ends(low, high); }

void BesideRenderer::compare(const std::vector<FilmedBall>& film, const Frame& run) { impl_->add_coverage(film, run); }

const Image& BesideRenderer::draw(const BesideMoment& moment) {
  Impl& my = *impl_;
  {
    const CurrentContext current(my.context);
    if (!my.is_painted) my.paint_still();
    my.still->restore();
    const auto marks_of_both = [&] {
      my.draw_surface();
      my.draw_edges(moment.run_edge, kRunInk, 1.005, 1.055);
      my.draw_edges(moment.film_edge, kFilmInk, 1.06, 1.11);
      my.name_edges(moment.film_edge, moment.run_edge);
      my.canvas->flush();
    };
    my.look_at(my.plan->film);
    if (my.style.view == BesideView::kDifference)
      my.draw_difference(*moment.run);
    else
      my.picture->draw(*moment.film, my.plan->film.left, my.plan->film.top);
    if (my.style.view == BesideView::kOverlay) my.draw_over_film(*moment.run);
    if (my.style.view == BesideView::kWipe) my.draw_wipe(moment);
    marks_of_both();
    if (my.style.view == BesideView::kSide) {
      my.look_at(my.plan->run);
      my.draw_run(*moment.run);
      marks_of_both();
    }
    draw_moving_words(*my.canvas, *my.plan, my.style, my.words, moment.clock, only_film(), only_run());
    my.canvas->flush();
  }
  return my.context.image();
}

double BesideRenderer::only_film() const { return impl_->coverage ? impl_->coverage->only_first() : kNotGiven; }
double BesideRenderer::only_run() const { return impl_->coverage ? impl_->coverage->only_second() : kNotGiven; }

}  // namespace tumble::render
