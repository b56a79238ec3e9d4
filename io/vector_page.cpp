#include "io/vector_page.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <array>
#include <utility>

#include "core/error.h"
#include "core/units.h"
#include "io/output.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

constexpr double kPointsPerMm = 72 / 25.4;
constexpr std::array kFonts{"/usr/share/fonts/truetype/liberation2/LiberationSans-Regular.ttf",
                            "/usr/share/fonts/truetype/liberation2/LiberationSans-Bold.ttf"};

// The file itself rather than a family's name: what a name finds differs from machine to machine.
cairo_font_face_t* font_of(const char* file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw WorkError(file, "font cannot be read; install the package fonts-liberation2");
  FcPattern* pattern = FcPatternCreate();
  FcPatternAddString(pattern, FC_FILE, reinterpret_cast<const FcChar8*>(file));
  FcPatternAddInteger(pattern, FC_INDEX, 0);
  cairo_font_face_t* face = cairo_ft_font_face_create_for_pattern(pattern);
  FcPatternDestroy(pattern);
  return face;
}

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

struct VectorPage::Cairo {
  std::string bytes = {};
  cairo_surface_t* surface = nullptr;
  cairo_t* context = nullptr;
  std::array<cairo_font_face_t*, kFonts.size()> fonts{};

  Cairo() = default;
  Cairo(const Cairo&) = delete;
  Cairo& operator=(const Cairo&) = delete;
  ~Cairo() {
    cairo_destroy(context);
    cairo_surface_destroy(surface);
    for (cairo_font_face_t* font : fonts) cairo_font_face_destroy(font);
  }

  void path(const std::vector<PagePoint>& points, bool closed) {
    cairo_new_path(context);
    for (const PagePoint& p : points) cairo_line_to(context, p.x, p.y);
    if (closed) cairo_close_path(context);
  }
  void arc(PagePoint centre, double radius) {
    cairo_new_path(context);
    cairo_arc(context, centre.x, centre.y, radius, 0, 2 * kPi);
  }
  void use(const Ink& ink) { cairo_set_source_rgba(context, ink.red, ink.green, ink.blue, ink.alpha); }
  void stroke(const Pen& pen) {
    use(pen.ink);
    cairo_set_line_width(context, pen.width);
    cairo_set_dash(context, pen.dashes.data(), static_cast<int>(pen.dashes.size()), 0);
    cairo_stroke(context);
  }
  void use(const Lettering& how) {
    cairo_set_font_face(context, fonts[how.bold ? 1 : 0]);
    cairo_set_font_size(context, how.size_pt / kPointsPerMm);
  }
  double advance(const std::string& words) const {
    cairo_text_extents_t extents;
    cairo_text_extents(context, words.c_str(), &extents);
    return extents.x_advance;
  }
};

VectorPage::VectorPage(fs::path path, double width_mm, double height_mm, const std::string& title)
    : path_(std::move(path)), cairo_(std::make_unique<Cairo>()) {
  Cairo& c = *cairo_;
  for (std::size_t i = 0; i < kFonts.size(); ++i) c.fonts[i] = font_of(kFonts[i]);
  const double width = width_mm * kPointsPerMm, height = height_mm * kPointsPerMm;
  if (path_.extension() == ".pdf") {
    c.surface = cairo_pdf_surface_create_for_stream(append, &c.bytes, width, height);
    cairo_pdf_surface_set_metadata(c.surface, CAIRO_PDF_METADATA_TITLE, title.c_str());
    cairo_pdf_surface_set_metadata(c.surface, CAIRO_PDF_METADATA_CREATE_DATE, nullptr);  // same input, same bytes
  } else {
    c.surface = cairo_svg_surface_create_for_stream(append, &c.bytes, width, height);
  }
  c.context = cairo_create(c.surface);
  cairo_scale(c.context, kPointsPerMm, kPointsPerMm);
  cairo_set_line_join(c.context, CAIRO_LINE_JOIN_ROUND);
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(c.context, options);
  cairo_font_options_destroy(options);
}

VectorPage::~VectorPage() = default;

void VectorPage::line(const std::vector<PagePoint>& points, const Pen& pen, bool closed) {
  cairo_->path(points, closed);
  cairo_->stroke(pen);
}

void VectorPage::area(const std::vector<PagePoint>& corners, const Ink& ink) {
  cairo_->path(corners, true);
  cairo_->use(ink);
  cairo_fill(cairo_->context);
}

void VectorPage::disc(PagePoint centre, double radius, const Ink& ink) {
  cairo_->arc(centre, radius);
  cairo_->use(ink);
  cairo_fill(cairo_->context);
}

void VectorPage::circle(PagePoint centre, double radius, const Pen& pen) {
  cairo_->arc(centre, radius);
  cairo_->stroke(pen);
}

void VectorPage::text(PagePoint baseline, const std::string& words, const Lettering& how) {
  cairo_t* c = cairo_->context;
  cairo_->use(how);
  cairo_->use(how.ink);
  cairo_save(c);
  cairo_translate(c, baseline.x, baseline.y);
  if (how.upwards) cairo_rotate(c, -kPi / 2);
  cairo_move_to(c, -how.along * cairo_->advance(words), 0);
  cairo_show_text(c, words.c_str());
  cairo_restore(c);
}

double VectorPage::text_width(const std::string& words, const Lettering& how) const {
  cairo_->use(how);
  return cairo_->advance(words);
}

void VectorPage::clip(PagePoint upper_left, double width, double height) {
  cairo_save(cairo_->context);
  cairo_rectangle(cairo_->context, upper_left.x, upper_left.y, width, height);
  cairo_clip(cairo_->context);
}

void VectorPage::unclip() { cairo_restore(cairo_->context); }

void VectorPage::save() {
  cairo_surface_finish(cairo_->surface);
  for (const cairo_status_t status : {cairo_status(cairo_->context), cairo_surface_status(cairo_->surface)})
    if (status != CAIRO_STATUS_SUCCESS)
      throw WorkError(path_.string(), std::string("cannot be drawn: ") + cairo_status_to_string(status));
  // cairo counts surfaces through the whole process; a page's bytes are not to tell what was drawn before it.
  std::string& bytes = cairo_->bytes;
  const std::string id = "<g id=\"surface";
  if (const auto at = bytes.find(id); path_.extension() == ".svg" && at != std::string::npos)
    bytes.erase(at + id.size(), bytes.find('"', at + id.size()) - at - id.size());
  write_text(path_, bytes);
}

bool VectorPage::writes(const fs::path& path) { return path.extension() == ".svg" || path.extension() == ".pdf"; }

}  // namespace tumble::io
