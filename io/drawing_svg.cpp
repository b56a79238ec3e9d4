#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "core/units.h"
#include "io/drawing_file.h"
#include "io/output.h"
#include "io/report/html.h"

namespace tumble::io {
namespace {

using Point = Drawing::Point;

std::string number(double value) {  // hundredths of a pixel, no idle zeros
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string place(const Point& p) { return number(p.x()) + " " + number(p.y()); }

std::string hex(Rgba c) { return fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b); }

Rgba shaded(Rgba c, double brightness) {
  const auto channel = [brightness](std::uint8_t value) { return static_cast<std::uint8_t>(value * brightness); };
  return {channel(c.r), channel(c.g), channel(c.b), c.a};
}

std::string painted(const char* what, Rgba c) {
  const std::string opacity = c.a == 255 ? "" : fmt::format(" {}-opacity=\"{}\"", what, number(c.a / 255.0));
  return fmt::format(" {}=\"{}\"{}", what, hex(c), opacity);
}

std::string path_through(const std::vector<Point>& points) {
  std::string path;
  for (const Point& p : points) {
    path += path.empty() ? 'M' : 'L';
    path += place(p);
  }
  return path;
}

class Writer {
 public:
  std::string text;

  void operator()(const Drawing::Polygon& s) {
    text += fmt::format("<path d=\"{}z\"{}{}/>\n", path_through(s.corners), painted("fill", s.fill),
                        s.has_neighbours ? " shape-rendering=\"crispEdges\"" : "");
  }
  void operator()(const Drawing::Stroke& s) {
    text += fmt::format("<path d=\"{}\" fill=\"none\"{} stroke-width=\"{}\"/>\n", path_through(s.points),
                        painted("stroke", s.colour), number(s.width));
  }
  void operator()(const Drawing::Ring& s) {
    const double from = std::min(s.from, s.to), to = std::max(s.from, s.to), middle = (s.inner + s.outer) / 2;
    const bool is_whole = to - from > 2 * kPi - 1e-9;
    if (is_whole && s.inner == 0) {
      circle(s.centre, s.outer, painted("fill", s.fill));
    } else if (s.inner == 0) {
      text += fmt::format("<path d=\"M{}L{}{}z\"{}/>\n", place(s.centre), place(at(s.centre, s.outer, from)),
                          arc(s.centre, s.outer, from, to), painted("fill", s.fill));
    } else {  // a stroke as wide as the ring
      const std::string pen =
          fmt::format(" fill=\"none\"{} stroke-width=\"{}\"", painted("stroke", s.fill), number(s.outer - s.inner));
      if (is_whole)
        circle(s.centre, middle, pen);
      else
        text += fmt::format("<path d=\"M{}{}\"{}/>\n", place(at(s.centre, middle, from)),
                            arc(s.centre, middle, from, to), pen);
    }
  }
  void operator()(const Drawing::Ball& s) {
    using Look = BallLook;
    const double limb = Look::limb(s.radius), r = s.radius - limb / 2;
    circle(s.centre, r,
           fmt::format("{}{} stroke-width=\"{}\"", painted("fill", s.colour),
                       painted("stroke", shaded(s.colour, Look::kLimbShade)), number(limb)));
    if (s.mark_strength > 0) {
      const auto along = [&](double radii) -> Point { return s.centre + radii * s.radius * s.mark; };
      const auto mark = [&](Rgba ink, double grow) {
        const std::string opacity = s.mark_strength < 1 ? fmt::format(" opacity=\"{:.2f}\"", s.mark_strength) : "";
        text += fmt::format("<g{}{}><path d=\"M{}L{}\"{} stroke-width=\"{}\"/>", opacity, painted("fill", ink),
                            place(along(-Look::kStripeHalf - grow)), place(along(Look::kStripeHalf + grow)),
                            painted("stroke", ink), number((Look::kStripe + 2 * grow) * s.radius));
        circle(along(Look::kDotAt), (Look::kDot + grow) * s.radius, "");
        text += "</g>\n";
      };
      const auto grey = static_cast<std::uint8_t>(255 * Look::kMarkGrey);
      mark(shaded(s.colour, Look::kHaloShade), Look::kHalo);
      mark({grey, grey, grey}, 0);
    }
    circle(s.centre, r, " fill=\"url(#light)\"");
  }
  void operator()(const Drawing::Label& s) {
    const char* anchor = s.anchor == 0 ? "" : s.anchor == 1 ? " text-anchor=\"end\"" : " text-anchor=\"middle\"";
    const std::string halo =
        s.halo_width > 0 ? fmt::format("{} stroke-width=\"{}\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
                                       painted("stroke", s.halo), number(2 * s.halo_width))
                         : "";
    text += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\"{}{}{}{}>{}</text>\n", number(s.at.x()),
                        number(s.at.y()), number(s.size), s.is_bold ? " font-weight=\"bold\"" : "", anchor,
                        painted("fill", s.colour), halo, report::escaped(s.text));
  }
  void operator()(const Drawing::Enter& s) {
    ++boxes_;
    text += fmt::format(
        "<clipPath id=\"box{0}\"><rect x=\"{1}\" y=\"{2}\" width=\"{3}\" height=\"{4}\"/></clipPath>"
        "<g clip-path=\"url(#box{0})\"><g transform=\"translate({5})\">\n",
        boxes_, number(s.left), number(s.top), number(s.right - s.left), number(s.bottom - s.top), place(s.offset));
  }
  void operator()(const Drawing::Leave&) { text += "</g></g>\n"; }

 private:
  static Point at(const Point& centre, double radius, double angle) {
    return centre + radius * Point(std::cos(angle), -std::sin(angle));
  }
  static std::string arc(const Point& centre, double radius, double from, double to) {
    return fmt::format("A{0} {0} 0 {1} 0 {2}", number(radius), to - from > kPi ? 1 : 0, place(at(centre, radius, to)));
  }
  void circle(const Point& centre, double radius, const std::string& paint) {
    text += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", number(centre.x()), number(centre.y()),
                        number(radius), paint);
  }

  int boxes_ = 0;
};

std::string light() {
  using Look = BallLook;
  std::string text = fmt::format("<radialGradient id=\"light\" cx=\"{0:.3f}\" cy=\"{1:.3f}\" r=\"{2:.3f}\">",
                                 0.5 + Look::kLightX / 2, 0.5 + Look::kLightY / 2, Look::kDarkAt / 2);
  for (const Look::Stop& stop : Look::kStops)
    text += fmt::format("<stop offset=\"{}\" stop-color=\"{}\" stop-opacity=\"{}\"/>", stop.at,
                        stop.white > 0 ? "#fff" : "#000", stop.alpha);
  return text + "</radialGradient>";
}

}  // namespace

double BallLook::limb(double radius_px) { return std::clamp(0.085 * radius_px, 0.5, 0.6 + 0.035 * radius_px); }

void write_svg(const std::filesystem::path& path, const Drawing& drawing) {
  Writer writer;
  writer.text =
      fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" )"
                  R"(font-family="DejaVu Sans, Verdana, Helvetica, Arial, sans-serif">)"
                  "\n<defs>{2}</defs>\n<rect width=\"{0}\" height=\"{1}\"{3}/>\n<g transform=\"translate(.5 .5)\">\n",
                  drawing.width, drawing.height, light(), painted("fill", drawing.ground));
  for (const Drawing::Shape& shape : drawing.shapes) std::visit(writer, shape);
  write_text(path, writer.text + "</g>\n</svg>\n");
}

}  // namespace tumble::io
