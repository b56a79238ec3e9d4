#include <cairo-pdf.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "core/units.h"
#include "io/drawing_file.h"
#include "io/output.h"

namespace tumble::io {
namespace {

constexpr double kPointsPerPixel = 0.75;  // 72 to the inch against 96

struct Painter {
  cairo_t* pen;

  void colour(Rgba c, double brightness = 1, double alpha = 1) const {
    cairo_set_source_rgba(pen, c.r * brightness / 255, c.g * brightness / 255, c.b * brightness / 255,
                          c.a * alpha / 255);
  }
  void trace(const std::vector<Drawing::Point>& points) const {
    for (const auto& p : points) cairo_line_to(pen, p.x(), p.y());
  }
  void stroke(double width) const {
    cairo_set_line_width(pen, width);
    cairo_stroke(pen);
  }
  void circle(const Drawing::Point& centre, double radius) const {
    cairo_new_sub_path(pen);
    cairo_arc(pen, centre.x(), centre.y(), radius, 0, 2 * kPi);
  }

  void operator()(const Drawing::Polygon& s) const {
    trace(s.corners);
    cairo_close_path(pen);
    colour(s.fill);
    cairo_fill(pen);
  }
  void operator()(const Drawing::Stroke& s) const {
    trace(s.points);
    colour(s.colour);
    stroke(s.width);
  }
  void operator()(const Drawing::Ring& s) const {
    const double from = -std::max(s.from, s.to), to = -std::min(s.from, s.to);  // cairo's angles go clockwise
    colour(s.fill);
    if (s.inner > 0) {
      cairo_arc(pen, s.centre.x(), s.centre.y(), (s.inner + s.outer) / 2, from, to);
      stroke(s.outer - s.inner);
    } else {
      if (to - from < 2 * kPi - 1e-9) cairo_move_to(pen, s.centre.x(), s.centre.y());
      cairo_arc(pen, s.centre.x(), s.centre.y(), s.outer, from, to);
      cairo_fill(pen);
    }
  }
  void operator()(const Drawing::Ball& s) const {
    using Look = BallLook;
    const double limb = Look::limb(s.radius), r = s.radius - limb / 2;
    circle(s.centre, r);
    colour(s.colour);
    cairo_fill_preserve(pen);
    colour(s.colour, Look::kLimbShade);
    stroke(limb);
    if (s.mark_strength > 0) {
      const auto mark = [&](double grow) {
        const Drawing::Point half = (Look::kStripeHalf + grow) * s.radius * s.mark;
        const Drawing::Point a = s.centre - half, b = s.centre + half;
        cairo_move_to(pen, a.x(), a.y());
        cairo_line_to(pen, b.x(), b.y());
        stroke((Look::kStripe + 2 * grow) * s.radius);
        circle(s.centre + Look::kDotAt * s.radius * s.mark, (Look::kDot + grow) * s.radius);
        cairo_fill(pen);
      };
      colour(s.colour, Look::kHaloShade, s.mark_strength);
      mark(Look::kHalo);
      colour({255, 255, 255}, Look::kMarkGrey, s.mark_strength);
      mark(0);
    }
    const double u = s.centre.x() + Look::kLightX * r, v = s.centre.y() + Look::kLightY * r;
    cairo_pattern_t* light = cairo_pattern_create_radial(u, v, 0, u, v, Look::kDarkAt * r);
    for (const Look::Stop& stop : Look::kStops)
      cairo_pattern_add_color_stop_rgba(light, stop.at, stop.white, stop.white, stop.white, stop.alpha);
    cairo_set_source(pen, light);
    cairo_pattern_destroy(light);
    circle(s.centre, r);
    cairo_fill(pen);
  }
  void operator()(const Drawing::Label& s) const {
    cairo_select_font_face(pen, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           s.is_bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(pen, s.size);
    cairo_text_extents_t extents;
    cairo_text_extents(pen, s.text.c_str(), &extents);
    const double left = s.at.x() - s.anchor * extents.x_advance;
    if (s.halo_width > 0) {
      cairo_move_to(pen, left, s.at.y());
      cairo_text_path(pen, s.text.c_str());
      cairo_set_line_join(pen, CAIRO_LINE_JOIN_ROUND);
      cairo_set_line_width(pen, 2 * s.halo_width);
      colour(s.halo);
      cairo_stroke(pen);
      cairo_set_line_join(pen, CAIRO_LINE_JOIN_MITER);
    }
    cairo_move_to(pen, left, s.at.y());
    colour(s.colour);
    cairo_show_text(pen, s.text.c_str());
    cairo_new_path(pen);
  }
  void operator()(const Drawing::Enter& s) const {
    cairo_save(pen);
    cairo_rectangle(pen, s.left, s.top, s.right - s.left, s.bottom - s.top);
    cairo_clip(pen);
    cairo_translate(pen, s.offset.x(), s.offset.y());
  }
  void operator()(const Drawing::Leave&) const { cairo_restore(pen); }
};

}  // namespace

void write_pdf(const std::filesystem::path& path, const Drawing& drawing) {
  StagedFile file(path);
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> sheet(
      cairo_pdf_surface_create(file.path().c_str(), drawing.width * kPointsPerPixel, drawing.height * kPointsPerPixel),
      cairo_surface_destroy);
  // Not the hour of writing: the same drawing gives the same bytes.
  cairo_pdf_surface_set_metadata(sheet.get(), CAIRO_PDF_METADATA_CREATE_DATE, "1970-01-01T00:00:00Z");
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> pen(cairo_create(sheet.get()), cairo_destroy);
  cairo_scale(pen.get(), kPointsPerPixel, kPointsPerPixel);
  const Painter painter{pen.get()};
  painter.colour(drawing.ground);
  cairo_paint(pen.get());
  cairo_translate(pen.get(), 0.5, 0.5);
  for (const Drawing::Shape& shape : drawing.shapes) std::visit(painter, shape);
  cairo_show_page(pen.get());
  cairo_surface_finish(sheet.get());
  const cairo_status_t status = std::max(cairo_status(pen.get()), cairo_surface_status(sheet.get()));
  if (status != CAIRO_STATUS_SUCCESS) throw WorkError(path.string(), cairo_status_to_string(status));
  file.commit();
}

}  // namespace tumble::io
