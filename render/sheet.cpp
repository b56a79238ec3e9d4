#include "render/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/mill_shape.h"
#include "render/axis.h"
#include "render/canvas.h"
#include "render/charge_view.h"
#include "render/marks.h"
#include "render/panel.h"
#include "render/still_layer.h"

namespace tumble::render {
namespace {

// In units of the layout, of which a picture is at least 900 wide and 720 high.
constexpr double kFoot = 86, kHead = 14, kCaption = 34, kGap = 12, kMargin = 28;
constexpr int kSmallestCell = 64;  // [px]

struct Cells {
  int edge = 0, columns = 1, rows = 1;
  int left(std::size_t i) const { return lefts[i]; }
  int top(std::size_t i) const { return tops[i]; }
  std::vector<int> lefts, tops;  // of the square pictures [px]
};

// As many columns as make the mills largest; a last row that is not full stands in the middle.
Cells place_cells(int width, int height, std::size_t count, double unit) {
  const double wide = width - 2 * kGap * unit, high = height - (kFoot + kHead) * unit;
  const int n = static_cast<int>(count);
  double largest = 0;
  Cells cells;
  for (int columns = 1; columns <= n; ++columns) {
    const int rows = (n + columns - 1) / columns;
    const double edge = std::min(wide / columns - kGap * unit, high / rows - (kCaption + kGap) * unit);
    if (edge <= largest) continue;
    largest = edge;
    cells.columns = columns;
    cells.rows = rows;
  }
  cells.edge = static_cast<int>(largest) / 2 * 2;
  if (cells.edge < kSmallestCell)
    throw InputError("size", fmt::format("{}x{} px has no room for {} mills; give a larger size", width, height, n));
  const double step_x = cells.edge + kGap * unit, step_y = cells.edge + (kCaption + kGap) * unit;
  const double first_top = kHead * unit + (high - cells.rows * step_y) / 2;
  for (int i = 0; i < n; ++i) {
    const int row = i / cells.columns, in_row = std::min(cells.columns, n - row * cells.columns);
    const double first_left = (width - in_row * step_x + kGap * unit) / 2;
    cells.lefts.push_back(static_cast<int>(std::lround(first_left + (i % cells.columns) * step_x)));
    cells.tops.push_back(static_cast<int>(std::lround(first_top + row * step_y + kCaption * unit)));
  }
  return cells;
}

double radius_of(const SheetMill& mill) { return mill.setup.config.mill.diameter / 2; }

// What still can be read of a label in so many pixels.
std::string fitted(Text& text, std::string label, const TextStyle& style, double width) {
  if (text.width(label, style) <= width) return label;
  do {  // a whole character of UTF-8 less
    while (!label.empty() && (static_cast<unsigned char>(label.back()) & 0xC0u) == 0x80u) label.pop_back();
    if (!label.empty()) label.pop_back();
  } while (!label.empty() && text.width(label + "…", style) > width);
  return label + "…";
}

}  // namespace

struct Sheet::Furniture {
  Furniture(const std::vector<SheetMill>& wanted, const Style& wanted_style)
      : style(wanted_style),
        theme(theme_of(style)),
        largest(*std::max_element(wanted.begin(), wanted.end(),
                                  [](const auto& a, const auto& b) { return radius_of(a) < radius_of(b); })),
        context(style.width, style.height, style.context) {
    for (const SheetMill& mill : wanted) {
      labels.push_back(mill.label);
      radii.insert(mill.setup.balls.radius.begin(), mill.setup.balls.radius.end());
    }
    scale.by = style.colour;
    scale.theme = &theme;
    const CurrentContext current(context);
    Layout layout;
    layout.unit = std::min(style.width / 900.0, style.height / 720.0);
    layout.picture = layout.view = {-0.5, -0.5, style.width - 0.5, style.height - 0.5};
    layout.zoom = style.view.zoom;
    cells = place_cells(style.width, style.height, wanted.size(), layout.unit);
    layout.camera.pixels_per_metre = style.view.zoom * kShellRadiusUnits * (cells.edge / 720.0) / radius_of(largest);
    canvas = std::make_unique<Canvas>(style.width, style.height, layout, theme);
    still = std::make_unique<StillLayer>(style.width, style.height);
  }

  Style style_of(const SheetMill& mill) const {
    Style cell = style;
    cell.width = cell.height = cells.edge;
    cell.overlay.text = false;
    cell.view.zoom *= radius_of(mill) / radius_of(largest);
    return cell;
  }

  void draw_still() const {
    const auto px = [this](double units) { return canvas->px(units); };
    for (std::size_t i = 0; i < labels.size(); ++i) {
      TextStyle name{canvas->letter(17), theme.text, Weight::kBold, Align::kCentre};
      while (name.size > canvas->letter(12) && canvas->text.width(labels[i], name) > cells.edge) name.size -= 1;
      canvas->text.add(fitted(canvas->text, labels[i], name, cells.edge), cells.left(i) + cells.edge / 2.0,
                       cells.top(i) - px(8), name);
    }
    const double top = style.height - px(kFoot - 16);
    canvas->meshes.line({px(kMargin), std::round(top - px(14))}, {style.width - px(kMargin), std::round(top - px(14))},
                        canvas->stroke(1.0), theme.faint);
    canvas->text.add(time_note(style.slow), px(kMargin + 118), top + px(38), {canvas->letter(13), theme.quiet});
    draw_scale_bar(*canvas, {style.width * 0.33, style.height - px(30)}, radius_of(largest), kNotGiven);
    const double right = style.width - px(kMargin);
    draw_colour_scale(*canvas, right - px(440), right, top + px(24), scale, radii);
    canvas->flush();
  }

  void draw_clock(double clock) const {
    const TextStyle large{canvas->letter(28), theme.text, Weight::kBold};
    const std::string seconds = fmt::format("{:.2f}", clock);
    const double baseline = style.height - canvas->px(kFoot - 54), left = canvas->px(kMargin);
    canvas->text.add(seconds, left, baseline, large);
    canvas->text.add("s", left + canvas->text.width(seconds, large) + canvas->px(6), baseline,
                     {canvas->letter(17), theme.quiet});
    canvas->flush();
  }

  Style style;
  const Theme& theme;
  SheetMill largest;
  std::vector<std::string> labels;
  std::set<double> radii;
  ColourScale scale;
  Cells cells;
  OffscreenContext context;
  std::unique_ptr<Canvas> canvas;
  std::unique_ptr<StillLayer> still;
  bool is_painted = false;
};

Sheet::Sheet(const std::vector<SheetMill>& mills, const Style& style) {
  if (mills.empty() || mills.size() > kMostMills)
    throw InputError("render", fmt::format("{} runs were given; give 1 to {}", mills.size(), kMostMills));
  if (mills.size() > 1) furniture_ = std::make_unique<Furniture>(mills, style);
  films_.resize(mills.size());
  for (const SheetMill& mill : mills)
    cells_.push_back(std::make_unique<Renderer>(mill.setup, furniture_ ? furniture_->style_of(mill) : style));
}
Sheet::~Sheet() = default;

void Sheet::set_scale(double low, double high) {
  for (const auto& cell : cells_) cell->set_scale(low, high);
  if (!furniture_) return;
  furniture_->scale.set_ends(low, high);
  furniture_->is_painted = false;
}

void Sheet::set_mean(std::size_t mill, const ChargeMotion& motion) { cells_[mill]->set_mean(motion); }

void Sheet::set_force_scale(double high) {
  for (const auto& cell : cells_) cell->set_force_scale(high);
}

double Sheet::trail_seconds() const {
  double longest = 0;
  for (const auto& cell : cells_) longest = std::max(longest, cell->trail_seconds());
  return longest;
}

FilmSquare Sheet::square() const {
  return {furniture_->cells.edge, 360 / kShellRadiusUnits / furniture_->style.view.zoom};
}

void Sheet::set_picture(std::size_t mill, Image picture) { films_[mill] = std::move(picture); }

const Image& Sheet::draw(std::span<const Frame> frames, std::span<const Moment> moments, double clock) {
  if (!furniture_) return cells_[0]->draw(frames[0], moments[0]);
  Furniture& my = *furniture_;
  {
    const CurrentContext current(my.context);
    if (!my.is_painted) {
      my.canvas->paint_ground();
      my.draw_still();
      my.still->capture();
      my.is_painted = true;
    }
    my.still->restore();
    my.draw_clock(clock);
  }
  picture_ = my.context.image();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Image& cell = films_[i].width > 0 ? films_[i] : cells_[i]->draw(frames[i], moments[i]);
    for (int v = 0; v < cell.height; ++v) {
      const std::uint8_t* from = cell.row(v);
      std::uint8_t* to = picture_.row(my.cells.top(i) + v) + static_cast<std::ptrdiff_t>(my.cells.left(i)) * 4;
      for (int u = 0; u < cell.width; ++u, from += 4, to += 4)
        if (from[3] != 0) std::copy_n(from, 4, to);
    }
  }
  return picture_;
}

Drawing Sheet::sketch(std::span<const Frame> frames, std::span<const Moment> moments, double clock) {
  if (!furniture_) return cells_[0]->sketch(frames[0], moments[0]);
  Furniture& my = *furniture_;
  Drawing drawing{my.style.width, my.style.height, my.theme.ground, {}};
  {
    const CurrentContext current(my.context);
    my.canvas->record_into(&drawing);
    my.draw_still();
    my.draw_clock(clock);
    my.canvas->record_into(nullptr);
  }
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const double left = my.cells.left(i), top = my.cells.top(i), edge = my.cells.edge;
    drawing.shapes.emplace_back(
        Drawing::Enter{{left, top}, left - 0.5, top - 0.5, left + edge - 0.5, top + edge - 0.5});
    for (Drawing::Shape& shape : cells_[i]->sketch(frames[i], moments[i]).shapes)
      drawing.shapes.push_back(std::move(shape));
    drawing.shapes.emplace_back(Drawing::Leave{});
  }
  return drawing;
}

}  // namespace tumble::render
