#include "render/beside_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "render/panel.h"

namespace tumble::render {
namespace {

constexpr double kHead = 62, kFoot = 66;  // of two squares side by side [units]

TextStyle quiet(const Canvas& canvas, double size, Align align = Align::kLeft) {
  return {canvas.letter(size), canvas.theme.quiet, Weight::kRegular, align};
}

// Lines of words no wider than `width`; a word that is too wide stands alone.
std::vector<std::string> wrapped(Canvas& canvas, const std::string& text, double width, const TextStyle& style) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at), longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && canvas.text.width(longer, style) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
    at = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

// No wider than `width`: what does not fit is cut from the front, for a path's end tells more than its beginning.
std::string fitted(Canvas& canvas, std::string text, double width, const TextStyle& style) {
  bool cut = false;
  while (text.size() > 1 && canvas.text.width((cut ? "…" : "") + text, style) > width) {
    do text.erase(0, 1);
    while (text.size() > 1 && (static_cast<unsigned char>(text.front()) & 0xC0) == 0x80);
    cut = true;
  }
  return (cut ? "…" : "") + text;
}

void swatch(Canvas& canvas, double x, double baseline, Rgba colour) {
  const double r = canvas.px(5.5);
  canvas.meshes.ring({x + r, baseline - canvas.px(5.2)}, 0, r, 0, 2 * kPi, colour);
}

// A dot of the source's colour, its role and name, and a line about it.
void source_lines(Canvas& canvas, double x, double y, double width, const BesideSource& source, Rgba colour) {
  const TextStyle bold{canvas.letter(16), canvas.theme.text, Weight::kBold}, name = quiet(canvas, 13);
  swatch(canvas, x, y, colour);
  const double indent = canvas.px(19);
  canvas.text.add(source.role, x + indent, y, bold);
  const double after = indent + canvas.text.width(source.role, bold) + canvas.px(9);
  canvas.text.add(fitted(canvas, source.name, width - after, name), x + after, y, name);
  canvas.text.add(fitted(canvas, source.detail, width - indent, name), x + indent, y + canvas.px(20), name);
}

// As many whole notes as have room, from `top` to `bottom`.
void notes(Canvas& canvas, double left, double right, double top, double bottom, const std::vector<std::string>& notes,
           double size) {
  const TextStyle style = quiet(canvas, size);
  const double step = 1.32 * style.size;
  double y = top + style.size;
  for (const std::string& note : notes) {
    const auto lines = wrapped(canvas, note, right - left, style);
    if (y + step * (static_cast<double>(lines.size()) - 1) > bottom) return;
    for (const std::string& line : lines) {
      canvas.text.add(line, left, y, style);
      y += step;
    }
    y += 0.35 * step;
  }
}

void rule(Canvas& canvas, double left, double right, double y) {
  canvas.meshes.line({left, std::round(y)}, {right, std::round(y)}, canvas.stroke(1.0), canvas.theme.faint);
}

// "film" or "photograph"
std::string lower_role(const BesideSource& source) {
  std::string role = source.role;
  if (!role.empty() && role[0] >= 'A' && role[0] <= 'Z') role[0] = static_cast<char>(role[0] - 'A' + 'a');
  return role;
}

std::string title_of(BesideView view, const BesideSource& film) {
  switch (view) {
    case BesideView::kOverlay:
      return "Simulation over " + lower_role(film);
    case BesideView::kWipe:
      return film.role + " and simulation";
    case BesideView::kDifference:
      return film.role + " against simulation";
    case BesideView::kSide:
      break;
  }
  return "";
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

// Places of the column, in units below its top.
constexpr double kClock = 116, kSources = 158, kTable = 260;

// Below the table: the key of the difference, then the notes.
double key_top(const BesideWords& words) { return kTable + 22 * (static_cast<double>(words.table.size()) + 1); }
double notes_top(const BesideStyle& style, const BesideWords& words) {
  return key_top(words) + (style.view == BesideView::kDifference ? 86 : 8);
}

void draw_column(Canvas& canvas, const RunSetup& setup, const BesideStyle& style, const BesideWords& words) {
  const Box& panel = canvas.layout.panel;
  const double left = panel.left, right = panel.right;
  const auto y = [&](double units) { return panel.top + canvas.px(units); };
  canvas.text.add(title_of(style.view, words.film), left, y(18), {canvas.letter(21), canvas.theme.text, Weight::kBold});
  const TextStyle small = quiet(canvas, 13);
  std::string mill = mill_in_words(setup.config) + " · " + charge_in_words(setup);
  if (canvas.text.width(mill, small) > right - left) mill = charge_in_words(setup);
  canvas.text.add(fitted(canvas, mill, right - left, small), left, y(42), small);
  rule(canvas, left, right, y(62));
  rule(canvas, left, right, y(134));
  source_lines(canvas, left, y(kSources), right - left, words.film, kFilmInk);
  source_lines(canvas, left, y(kSources + 46), right - left, words.run, kRunInk);
  rule(canvas, left, right, y(kTable - 22));

  const double columns[] = {left + canvas.px(214), left + canvas.px(330), right};
  const std::string heads[] = {lower_role(words.film), "simulation", "difference"};
  for (int c = 0; c < 3; ++c) canvas.text.add(heads[c], columns[c], y(kTable), quiet(canvas, 12, Align::kRight));
  double row = kTable + 22;
  for (const BesideRow& r : words.table) {
    const TextStyle value{canvas.letter(13), canvas.theme.text, Weight::kRegular, Align::kRight};
    canvas.text.add(r.name, left, y(row), quiet(canvas, 13));
    // Letters do not shrink below what can be read: a small picture has no room for errors.
    const auto shown = [&](const std::string& text) {
      return canvas.layout.unit < 0.75 ? text.substr(0, text.find(" ±")) : text;
    };
    canvas.text.add(shown(r.film), columns[0], y(row), value);
    canvas.text.add(shown(r.run), columns[1], y(row), value);
    canvas.text.add(shown(r.difference), columns[2], y(row), value);
    row += 22;
  }
  if (style.view == BesideView::kDifference) {
    rule(canvas, left, right, y(key_top(words) - 8));
    const char* keys[] = {"only the film has balls here", "only the simulation has balls here", "both have"};
    const Rgba colours[] = {kFilmInk, kRunInk, canvas.theme.steel};
    for (int k = 0; k < 3; ++k) {
      swatch(canvas, left, y(key_top(words) + 16 + 22 * k), colours[k]);
      canvas.text.add(keys[k], left + canvas.px(19), y(key_top(words) + 16 + 22 * k),
                      {canvas.letter(13), canvas.theme.text});
    }
  }
  rule(canvas, left, right, y(notes_top(style, words) - 10));
  notes(canvas, left, right, y(notes_top(style, words) + 6), panel.bottom - canvas.px(54), words.notes,
        12);  // the scale bar stands below
}

}  // namespace

BesidePlan::BesidePlan(Canvas& canvas, BesideView view) {
  const Box& picture = canvas.layout.picture;
  const double unit = canvas.layout.unit;
  two = view == BesideView::kSide;
  if (two) {
    stacked = picture.width() < picture.height();
    const int across = stacked ? 1 : 2, down = stacked ? 2 : 1;
    edge = static_cast<int>(std::floor(
        std::min(picture.width() / across - 16 * unit, (picture.height() - kFoot * unit) / down - kHead * unit)));
    const double cell = picture.width() / across, step = kHead * unit + edge;
    const double top = (picture.height() - down * step - kFoot * unit) / 2 + kHead * unit;
    const auto place = [&](int i, int j) {
      return Place{static_cast<int>(std::lround((i + 0.5) * cell - 0.5 * edge)),
                   static_cast<int>(std::lround(top + j * step))};
    };
    film = place(0, 0);
    run = stacked ? place(0, 1) : place(1, 0);
  } else {
    const Camera& camera = canvas.layout.camera;
    edge = static_cast<int>(std::lround(2 * margin * kShellRadiusUnits * unit));
    film.left = static_cast<int>(std::lround(camera.centre_u + 0.5 - 0.5 * edge));
    film.top = static_cast<int>(std::lround(camera.centre_v + 0.5 - 0.5 * edge));
    run = film;
  }
}

void draw_still_words(Canvas& canvas, const BesidePlan& plan, const RunSetup& setup, const BesideStyle& style,
                      const BesideWords& words) {
  if (!plan.two) {
    draw_column(canvas, setup, style, words);
    return;
  }
  const double head = canvas.px(kHead - 24);
  source_lines(canvas, plan.film.left, plan.film.top - canvas.px(kHead) + canvas.px(28), plan.edge, words.film,
               kFilmInk);
  source_lines(canvas, plan.run.left, plan.run.top - head + canvas.px(4), plan.edge, words.run, kRunInk);
  const double left = canvas.layout.picture.left + canvas.layout.picture.width() * (plan.stacked ? 0.42 : 0.5);
  const double foot = std::max(plan.film.top, plan.run.top) + plan.edge;
  notes(canvas, left + canvas.px(110), canvas.layout.picture.right - canvas.px(20), foot + canvas.px(8),
        canvas.layout.picture.bottom - canvas.px(4), words.notes, 12);
}

void draw_moving_words(Canvas& canvas, const BesidePlan& plan, const BesideStyle& style, const BesideWords& words,
                       double clock, double only_film, double only_run) {
  auto& text = canvas.text;
  const bool still = std::isnan(clock);  // has no clock
  const std::string seconds = still ? "" : fmt::format("{:.2f}", clock), pace = still ? "" : time_note(style.slow);
  const char* unit = still ? "no clock" : "s";
  if (plan.two) {
    const double foot = std::max(plan.film.top, plan.run.top) + plan.edge;
    const TextStyle large{canvas.letter(30), canvas.theme.text, Weight::kBold};
    const double middle = canvas.layout.picture.left + canvas.layout.picture.width() * (plan.stacked ? 0.42 : 0.5);
    const double baseline = foot + canvas.px(36), width = text.width(seconds, large);
    text.add(seconds, middle - width / 2, baseline, large);
    text.add(unit, middle + width / 2 + canvas.px(still ? -34 : 6), baseline, {canvas.letter(16), canvas.theme.quiet});
    text.add(pace, middle, baseline + canvas.px(19), quiet(canvas, 12, Align::kCentre));
    return;
  }
  const Box& panel = canvas.layout.panel;
  const auto y = [&](double units) { return panel.top + canvas.px(units); };
  const TextStyle large{canvas.letter(40), canvas.theme.text, Weight::kBold};
  text.add(seconds, panel.left, y(kClock), large);
  text.add(unit, panel.left + text.width(seconds, large) + canvas.px(still ? 0 : 8), y(kClock),
           {canvas.letter(20), canvas.theme.quiet});
  text.add(pace, panel.right, y(kClock), quiet(canvas, 13, Align::kRight));
  if (style.view != BesideView::kDifference) return;
  const TextStyle value{canvas.letter(13), canvas.theme.text, Weight::kBold, Align::kRight};
  text.add(percent(only_film), panel.right, y(key_top(words) + 16), value);
  text.add(percent(only_run), panel.right, y(key_top(words) + 38), value);
  text.add(percent(1 - only_film - only_run), panel.right, y(key_top(words) + 60), value);
}

}  // namespace tumble::render
