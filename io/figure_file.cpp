#include "io/figure_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/angle.h"
#include "core/quantile.h"
#include "io/vector_page.h"

namespace tumble::io {
namespace {

// All in millimetres but the letters.
constexpr double kRow = 4.0, kBetweenPanels = 5.0, kTick = 1.1, kMarkRadius = 0.85, kBarCap = 0.7, kSample = 6.5,
                 kBesideSample = 1.2, kToAxisName = 7.2;
constexpr double kFrameShape = 0.70;  // height of a panel's frame over its width
constexpr double kCapHeight = 2.0;    // of the letters
const Ink kBlack{0.1, 0.1, 0.1}, kPaper{1, 1, 1};
const Pen kFrame{kBlack, 0.18}, kBar{kBlack, 0.2};

// By PlotSeries::colour; neighbours differ in grey as well as in hue, and each has a mark of its own.
constexpr std::array kInks{Ink{0.25, 0.25, 0.25}, Ink{0.05, 0.27, 0.58}, Ink{0.87, 0.45, 0.05}, Ink{0.02, 0.42, 0.33},
                           Ink{0.42, 0.62, 0.85}, Ink{0.55, 0.10, 0.30}, Ink{0.72, 0.62, 0.10}, Ink{0.45, 0.28, 0.62}};
const std::array<std::vector<PagePoint>, 5> kMarks{{{},  // a disc
                                                    {{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}},
                                                    {{0, -1.25}, {1.1, 0.75}, {-1.1, 0.75}},
                                                    {{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}},
                                                    {{0, 1.25}, {1.1, -0.75}, {-1.1, -0.75}}}};
const std::array<std::vector<double>, 4> kDashes{{{1.8, 1.0}, {2.6, 0.8}, {0.7, 0.7}, {2.2, 0.7, 0.6, 0.7}}};

struct Axis {
  double low = 0, high = 1, step = 1;
  bool direction = false;
  double share(double v) const { return (v - low) / (high - low); }
  std::vector<double> ticks() const {
    std::vector<double> list;
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) list.push_back(k * step);
    return list;
  }
  std::string name(double v) const {
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    const std::string text = fmt::format("{:.{}f}", std::abs(direction ? wrap_360(v) : v), decimals);
    return v < -step / 2 && !direction ? "\u2212" + text : text;
  }
};

double step_for(double range, double about, bool direction) {
  if (direction)
    for (const double step : {1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0})
      if (range / step <= about) return step;
  const double size = std::pow(10, std::floor(std::log10(range / about)));
  for (const double k : {1.0, 2.0, 5.0})
    if (range / (k * size) <= about) return k * size;
  return 10 * size;
}

struct Span {
  double low = INFINITY, high = -INFINITY;
  void take(double v) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
};

// What has an error was measured or simulated at points, which are marked; what has none is a curve.
bool has_marks(const PlotSeries& s) { return s.mark == PlotMark::kPoints || !s.se.empty(); }

double error_of(const PlotSeries& s, std::size_t i) { return s.se.empty() || !(s.se[i] > 0) ? 0 : s.se[i]; }

// All that is marked. A formula may run off to where it does not hold: of a curve its inner half, and no more than once
// the points' range beyond that.
Span heights_of(const Plot& plot) {
  Span marked, curves;
  for (const PlotSeries& s : plot.series)
    for (std::size_t i = 0; i < s.y.size() && has_marks(s); ++i)
      for (const double side : {-1, 1}) marked.take(s.y[i] + side * error_of(s, i));
  Span span = marked;
  for (const PlotSeries& s : plot.series) {
    std::vector<double> known;
    for (const double y : s.y)
      if (std::isfinite(y)) known.push_back(y), curves.take(y);
    if (has_marks(s) || known.empty()) continue;
    span.take(quantile_of(known, 0.25));
    span.take(quantile_of(known, 0.75));
  }
  const double room = marked.high > marked.low ? marked.high - marked.low : INFINITY;
  if (curves.high >= curves.low) {
    span.take(std::max(curves.low, span.low - room));
    span.take(std::min(curves.high, span.high + room));
  }
  if (plot.y_from_zero) span.take(0);
  return span;
}

Span places_of(const Plot& plot) {
  Span span;
  for (const PlotSeries& s : plot.series)
    for (const double x : s.x) span.take(x);
  return span;
}

constexpr double kMostSteps = 7;  // along an axis

Axis axis_over(Span span, bool direction) {
  if (!(span.high >= span.low)) return {};
  if (span.high == span.low) {
    const double room = 0.5 * std::max(std::abs(span.low), 1.0);
    span = {span.low - room, span.high + room};
  }
  return {span.low, span.high, step_for(span.high - span.low, kMostSteps, direction), direction};
}

// A little more than all of it.
Axis axis_along(const Plot& plot) {
  Axis axis = axis_over(places_of(plot), false);
  const double room = 0.04 * (axis.high - axis.low);
  axis.low -= room;
  axis.high += room;
  return axis;
}

// To whole steps.
Axis axis_upright(const Plot& plot) {
  Axis axis = axis_over(heights_of(plot), plot.y_is_direction);
  axis.low = axis.step * std::floor(axis.low / axis.step + 1e-9);
  axis.high = axis.step * std::ceil(axis.high / axis.step - 1e-9);
  return axis;
}

const Ink& ink_of(const PlotSeries& s) { return kInks[static_cast<std::size_t>(s.colour) % kInks.size()]; }

Pen pen_of(const PlotSeries& s) {
  if (!s.dashed) return {ink_of(s), 0.35};
  return {ink_of(s), 0.3, kDashes[static_cast<std::size_t>(s.colour) % kDashes.size()]};
}

// Full on a line, hollow where the points stand alone.
void draw_mark(VectorPage& page, const PlotSeries& s, PagePoint at) {
  const bool hollow = s.mark == PlotMark::kPoints;
  const Pen edge{ink_of(s), 0.25};
  std::vector<PagePoint> corners = kMarks[static_cast<std::size_t>(s.colour) % kMarks.size()];
  for (PagePoint& p : corners) p = {at.x + kMarkRadius * p.x, at.y + kMarkRadius * p.y};
  if (corners.empty()) {
    page.disc(at, kMarkRadius, hollow ? kPaper : ink_of(s));
    page.circle(at, kMarkRadius, edge);
  } else {
    page.area(corners, hollow ? kPaper : ink_of(s));
    page.line(corners, edge, true);
  }
}

// --- the legend

struct Name {
  const PlotSeries* series;
  PagePoint at;  // of its sample's left end
};
struct Legend {
  std::vector<Name> names;
  double height = 0;
};

// In one row if they fit, else down columns of equal width.
Legend legend_of(const VectorPage& page, const std::vector<Plot>& panels, double left, double width) {
  constexpr double kGap = 4;
  Legend legend;
  std::vector<double> widths;
  for (const Plot& plot : panels)
    for (const PlotSeries& s : plot.series) {
      const bool known = std::any_of(legend.names.begin(), legend.names.end(),
                                     [&](const Name& name) { return name.series->label == s.label; });
      if (known || s.label.empty()) continue;
      legend.names.push_back({&s, {}});
      widths.push_back(kSample + kBesideSample + page.text_width(s.label, {}) + kGap);
    }
  if (widths.empty()) return legend;
  const bool one_row = std::accumulate(widths.begin(), widths.end(), 0.0) <= width + kGap;
  const double widest = *std::max_element(widths.begin(), widths.end());
  const std::size_t columns =
      one_row ? widths.size() : static_cast<std::size_t>(std::max(1.0, std::floor((width + kGap) / widest)));
  const std::size_t rows = (widths.size() + columns - 1) / columns;
  double x = left;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    legend.names[i].at = {x, (static_cast<double>(i % rows) + 0.5) * kRow};
    if ((i + 1) % rows == 0) x += one_row ? widths[i] : widest;
  }
  legend.height = static_cast<double>(rows) * kRow + 1;
  return legend;
}

void draw(VectorPage& page, const Legend& legend) {
  for (const auto& [s, at] : legend.names) {
    if (s->mark == PlotMark::kLine) page.line({at, {at.x + kSample, at.y}}, pen_of(*s));
    if (has_marks(*s)) draw_mark(page, *s, {at.x + 0.5 * kSample, at.y});
    page.text({at.x + kSample + kBesideSample, at.y + 0.5 * kCapHeight}, s->label, {.ink = kBlack});
  }
}

// --- a panel

struct Panel {
  const Plot& plot;
  Axis x, y;
  double left = 0, top = 0, width = 0, height = 0;  // of its frame
  PagePoint at(double vx, double vy) const { return {left + x.share(vx) * width, top + (1 - y.share(vy)) * height}; }
};

std::vector<std::size_t> in_order(const PlotSeries& s) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < s.y.size(); ++i)
    if (std::isfinite(s.x[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return s.x[a] < s.x[b]; });
  return order;
}

void draw_band(VectorPage& page, const Panel& panel, const PlotSeries& s) {
  Ink pale = ink_of(s);
  pale.alpha = 0.25;
  std::vector<PagePoint> band, below;
  const auto close = [&] {
    band.insert(band.end(), below.rbegin(), below.rend());
    if (band.size() > 2) page.area(band, pale);
    band.clear(), below.clear();
  };
  for (const std::size_t i : in_order(s)) {
    if (std::isnan(s.y[i])) {
      close();
      continue;
    }
    band.push_back(panel.at(s.x[i], s.y[i] + error_of(s, i)));
    below.push_back(panel.at(s.x[i], s.y[i] - error_of(s, i)));
  }
  close();
}

void draw_line(VectorPage& page, const Panel& panel, const PlotSeries& s) {
  std::vector<PagePoint> line;
  for (const std::size_t i : in_order(s)) {
    if (!std::isnan(s.y[i])) {
      line.push_back(panel.at(s.x[i], s.y[i]));
      continue;
    }
    page.line(line, pen_of(s));
    line.clear();
  }
  page.line(line, pen_of(s));
}

void draw_points(VectorPage& page, const Panel& panel, const PlotSeries& s) {
  for (std::size_t i = 0; i < s.y.size(); ++i) {
    if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) continue;
    if (const double se = error_of(s, i); se > 0 && s.mark == PlotMark::kPoints) {
      const PagePoint high = panel.at(s.x[i], s.y[i] + se), low = panel.at(s.x[i], s.y[i] - se);
      const Pen bar{ink_of(s), kBar.width};
      page.line({low, high}, bar);
      for (const PagePoint& end : {low, high}) page.line({{end.x - kBarCap, end.y}, {end.x + kBarCap, end.y}}, bar);
    }
    draw_mark(page, s, panel.at(s.x[i], s.y[i]));
  }
}

void draw(VectorPage& page, const Panel& p, const std::string& letter) {
  const double right = p.left + p.width, bottom = p.top + p.height;
  page.clip({p.left, p.top}, p.width, p.height);
  for (const PlotSeries& s : p.plot.series)
    if (s.mark == PlotMark::kLine && !s.se.empty()) draw_band(page, p, s);
  for (const PlotSeries& s : p.plot.series)
    if (s.mark == PlotMark::kLine) draw_line(page, p, s);
  page.unclip();
  page.line({{p.left, p.top}, {right, p.top}, {right, bottom}, {p.left, bottom}}, kFrame, true);
  for (const double v : p.x.ticks()) {
    const double x = p.at(v, p.y.low).x;
    page.line({{x, bottom}, {x, bottom - kTick}}, kFrame);
    page.line({{x, p.top}, {x, p.top + kTick}}, kFrame);
    page.text({x, bottom + 1.2 + kCapHeight}, p.x.name(v), {.along = 0.5, .ink = kBlack});
  }
  double names = 0;  // the widest of the upright axis
  for (const double v : p.y.ticks()) {
    const double y = p.at(p.x.low, v).y;
    page.line({{p.left, y}, {p.left + kTick, y}}, kFrame);
    page.line({{right, y}, {right - kTick, y}}, kFrame);
    page.text({p.left - 1.2, y + 0.5 * kCapHeight}, p.y.name(v), {.along = 1, .ink = kBlack});
    names = std::max(names, page.text_width(p.y.name(v), {}));
  }
  for (const PlotSeries& s : p.plot.series)  // over the frame: a point at its edge is whole
    if (has_marks(s)) draw_points(page, p, s);
  page.text({p.left + 0.5 * p.width, bottom + kToAxisName}, p.plot.x_label, {.along = 0.5, .ink = kBlack});
  page.text({p.left - 2.4 - names, p.top + 0.5 * p.height}, p.plot.y_label,
            {.along = 0.5, .upwards = true, .ink = kBlack});
  if (letter.empty()) return;
  const Lettering bold{.bold = true, .ink = kBlack};
  page.text({p.left, p.top - 1.5}, letter, bold);
  page.text({p.left + page.text_width(letter, bold) + 1.2, p.top - 1.5}, p.plot.title, {.ink = kBlack});
}

void check(const Plot& plot) {
  bool fits = !plot.x_log && !plot.y_log && !plot.x_is_direction && plot.upright.empty() && plot.level.empty();
  for (const PlotSeries& s : plot.series)
    fits = fits && s.mark != PlotMark::kSteps && s.low.empty() && s.high.empty() && s.x.size() == s.y.size() &&
           (s.se.empty() || s.se.size() == s.y.size()) && s.colour >= 0;
  if (!fits) throw std::logic_error("the plot " + plot.title + " has what no figure is made for");
}

}  // namespace

void write_figure(const std::filesystem::path& path, const std::vector<Plot>& panels, double width_mm) {
  for (const Plot& plot : panels) check(plot);
  const auto count = static_cast<double>(panels.size());
  const bool lettered = panels.size() > 1;
  std::vector<Axis> upright;
  for (const Plot& plot : panels) upright.push_back(axis_upright(plot));

  // Measured on a page that is thrown away: the real one's height depends on its letters.
  const VectorPage rule(path, width_mm, 1, "");
  double names = 0;
  for (const Axis& axis : upright)
    for (const double v : axis.ticks()) names = std::max(names, rule.text_width(axis.name(v), {}));
  const double margin = names + 2.4 + kRow, rim = 1.5;
  const double frame = (width_mm - rim - (count - 1) * kBetweenPanels) / count - margin;
  const Legend legend = legend_of(rule, panels, margin, width_mm - rim - margin);
  const double top = legend.height + (lettered ? kRow + 0.5 : rim), height = kFrameShape * frame;

  VectorPage page(path, width_mm, top + height + kToAxisName + 1.2, panels.front().title);
  draw(page, legend);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double left = margin + static_cast<double>(i) * (margin + frame + kBetweenPanels);
    draw(page, Panel{panels[i], axis_along(panels[i]), upright[i], left, top, frame, height},
         lettered ? fmt::format("({})", static_cast<char>('a' + i)) : "");
  }
  page.save();
}

}  // namespace tumble::io
