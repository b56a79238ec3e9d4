#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/motion_quantities.h"
#include "io/comparison_file.h"
#include "io/json_number.h"
#include "io/plot_page.h"
#include "io/report/embedded.h"
#include "io/report/figure.h"
#include "io/report/html.h"
#include "io/report/mill_picture.h"
#include "io/report/section.h"

namespace tumble::io {
using namespace report;
namespace {

constexpr double kPathDots = 0.1;  // [s] between the dots along a path
constexpr int kGold = 5;           // of the plots' palette: what is beyond chance

struct Words {
  const char* name;
  const char* title;
  const char* y_label;
  const char* caption;
};
constexpr Words kLines[] = {
    {"ring_occupancy", "Ring just inside the lifter tips", "share covered by balls",
     "Time mean by angle, counter-clockwise from 3 o’clock. Upright: toe and shoulder of A and B."},
    {"surface", "Free surface", "height, m",
     "Height of the surface above the axis, square to the bed; both are seen along the same direction."},
    {"velocity_through_bed", "Velocity through the bed", "m/s",
     "Mean velocity along the bed, towards the shoulder, on the line through the axis and the middle of the bed."},
    {"torque_over_lifter_passage", "Torque of one slice over a lifter’s passage", "N m",
     "Mean of all passages at the same place of the lifters, which is the only clock that A and B have in common."},
    {"torque_spectrum", "Torque of one slice, power spectrum", "(N m)² s",
     "Geometric mean over stretches of the run, with its error. z is that of the ratio."},
    {"head_spectrum", "Head of the charge, power spectrum", "m² s",
     "Likewise. In films its fast end is the noise of single pictures."},
    {"impacts_ball_ball", "Impacts, ball on ball", "impacts per second and bin",
     "By the energy lost in an impact. Errors are those of counts, with an allowance for bursts."},
    {"impacts_ball_wall", "Impacts, ball on wall", "impacts per second and bin", "Likewise, on shell and lifters."},
};

const Words* words_of(const std::string& name) {
  for (const Words& w : kLines)
    if (name == w.name) return &w;
  return nullptr;
}

bool is_spectrum(const SampledDifference& d) { return d.name.ends_with("_spectrum"); }
bool is_over_time(const SampledDifference& d) { return is_spectrum(d) || d.name == "torque_over_lifter_passage"; }
bool is_impacts(const SampledDifference& d) { return d.name.starts_with("impacts_"); }

const char* name_of_kind(MotionSource source) {
  switch (source) {
    case MotionSource::kRunFile:
      return "simulation";
    case MotionSource::kFilm:
      return "film";
    case MotionSource::kTracks:
      return "tracks";
    case MotionSource::kStills:
      break;
  }
  return "stills";
}

std::string file_name(const ChargeMotion& m) { return std::filesystem::path(m.origin).filename().string(); }

// --- plots

// Directions beside the middle of the charge rather than in [0, 360), so that no line jumps across.
struct Cut {
  double at = 0;
  double turned(double deg) const { return at + wrap_360(deg - at); }
};

// Opposite to the middle of what both rings hold.
Cut emptiest(const SampledDifference& ring) {
  double c = 0, s = 0;
  for (std::size_t i = 0; i < ring.x.size(); ++i)
    for (const double o : {ring.a[i], ring.b[i]})
      if (std::isfinite(o)) c += o * std::cos(radians(ring.x[i])), s += o * std::sin(radians(ring.x[i]));
  return {wrap_360(30 * std::round((degrees(std::atan2(s, c)) + 180) / 30))};
}

std::vector<PlotRule> edges_of(const Comparison& c, const Cut& cut) {
  constexpr double kRoom = 40;  // [degrees] that a name takes
  std::vector<PlotRule> rules;
  for (const auto& [edge, name] :
       {std::pair{&ChargeMotion::toe_deg, "toe "}, {&ChargeMotion::shoulder_deg, "shoulder "}}) {
    const double a = cut.turned((c.a.motion->*edge).value), b = cut.turned((c.b.motion->*edge).value);
    const bool close = std::abs(a - b) < kRoom;
    if (std::isfinite(a)) rules.push_back({a, name + std::string(close ? "" : "A")});
    if (std::isfinite(b)) rules.push_back({b, close ? "" : name + std::string("B")});
  }
  return rules;
}

// Two plots: both, and their difference.
std::vector<Plot> plots_of(const SampledDifference& d, const Comparison& c) {
  const Words* words = words_of(d.name);
  if (words == nullptr) return {};
  const bool ring = d.name == "ring_occupancy", spectrum = is_spectrum(d) || is_impacts(d);
  std::vector<double> x = d.x;
  Cut cut;
  if (ring) {
    cut = emptiest(d);
    for (double& deg : x) deg = cut.turned(deg);
  }
  const std::string x_label = d.x_name + ", " + (d.x_unit == "deg" ? "degrees" : d.x_unit);
  Plot both{.title = words->title,
            .x_label = x_label,
            .y_label = words->y_label,
            .x_log = spectrum,
            .y_log = spectrum,
            .x_is_direction = ring,
            .caption = words->caption};
  both.series = {{.label = "A", .x = x, .y = d.a, .se = d.a_se, .colour = 0},
                 {.label = "B", .x = x, .y = d.b, .se = d.b_se, .colour = 1}};
  if (ring) both.upright = edges_of(c, cut);

  Plot apart{.title = "Difference",
             .x_label = x_label,
             .y_label = spectrum ? "B / A" : std::string("B − A, ") + words->y_label,
             .x_log = spectrum,
             .y_log = spectrum,
             .x_is_direction = ring};
  PlotSeries line{.label = spectrum ? "B / A" : "B − A", .x = x, .colour = 1};
  PlotSeries named{.label = "beyond chance", .mark = PlotMark::kPoints, .colour = kGold};
  for (std::size_t i = 0; i < x.size(); ++i) {
    double y = d.difference[i], se = d.se[i];
    if (spectrum) {
      y = d.b[i] / d.a[i];
      se = y * std::hypot(d.a_se[i] / d.a[i], d.b_se[i] / d.b[i]);
    }
    line.y.push_back(y);
    line.se.push_back(se);
    if (!d.significant[i]) continue;
    named.x.push_back(x[i]);
    named.y.push_back(y);
  }
  apart.caption = d.compared == 0 ? "Without standard errors: nothing can be said of chance."
                                  : fmt::format("Band: one standard error. Beyond chance in {} of {} places.",
                                                d.beyond_chance, d.compared);
  apart.series = {line};
  if (!named.x.empty()) apart.series.push_back(named);
  apart.level = {{spectrum ? 1.0 : 0.0}};
  return {both, apart};
}

struct Span {
  double low = INFINITY, high = -INFINITY;
};

// Shares of frames by value, on the bins of both.
PlotSeries shares(const std::vector<double>& values, const Span& span, int bins, const char* label, int colour) {
  PlotSeries s{.label = label, .mark = PlotMark::kSteps, .colour = colour};
  const double width = (span.high - span.low) / bins;
  for (int i = 0; i <= bins; ++i) s.x.push_back(span.low + width * i);
  s.y.assign(static_cast<std::size_t>(bins), 0);
  for (const double v : values)
    s.y[static_cast<std::size_t>(std::clamp(static_cast<int>((v - span.low) / width), 0, bins - 1))] +=
        1.0 / static_cast<double>(values.size());
  return s;
}

template <typename Get>
void add_shares(std::vector<Plot>& plots, const Comparison& c, const char* title, const char* x_label, bool direction,
                const Get& get) {
  constexpr int kBins = 40;
  std::vector<double> a = get(*c.a.motion), b = get(*c.b.motion);
  Span span;
  for (auto* values : {&a, &b}) {
    std::erase_if(*values, [](double v) { return !std::isfinite(v); });
    for (const double v : *values) span = {std::min(span.low, v), std::max(span.high, v)};
  }
  if (a.empty() || b.empty() || !(span.high > span.low)) return;
  Plot plot{.title = title,
            .x_label = x_label,
            .y_label = "share of frames",
            .y_from_zero = true,
            .x_is_direction = direction};
  plot.series = {shares(a, span, kBins, "A", 0), shares(b, span, kBins, "B", 1)};
  plots.push_back(plot);
}

// How often each value comes: frames are compared as a crowd, never one with another.
std::vector<Plot> distributions(const Comparison& c) {
  std::vector<Plot> plots;
  const auto directions = [&](Estimate ChargeMotion::*mean, double ProfileRow::*of) {
    const double middle = c.a.motion->*mean.*(&Estimate::value);
    return [=](const ChargeMotion& m) {
      std::vector<double> out;
      for (const ProfileRow& row : m.profile) out.push_back(middle + wrap_180(row.*of - middle));
      return out;
    };
  };
  add_shares(plots, c, "Toe", "degrees", true, directions(&ChargeMotion::toe_deg, &ProfileRow::toe_deg));
  add_shares(plots, c, "Shoulder", "degrees", true, directions(&ChargeMotion::shoulder_deg, &ProfileRow::shoulder_deg));
  add_shares(plots, c, "Head", "m", false, [](const ChargeMotion& m) {
    std::vector<double> out;
    for (const ProfileRow& row : m.profile) out.push_back(row.head);
    return out;
  });
  add_shares(plots, c, "Torque of one slice", "N m", false, [](const ChargeMotion& m) {
    std::vector<double> out;
    for (const TorqueRow& row : m.torque_series) out.push_back(row.torque);
    return out;
  });
  if (!plots.empty()) plots[0].caption = "Toe and shoulder of a frame: running mean over one lifter passage.";
  return plots;
}

std::vector<PageSection> plot_sections(const Comparison& c) {
  PageSection profile{.heading = "Profiles, and how they differ"}, rhythm{.heading = "Torque in time, and rhythm"},
      impacts{.heading = "Impacts"};
  profile.paragraphs = {
      "Click a name below a plot to hide or show its line; drag to zoom in, double-click to zoom out."};
  rhythm.paragraphs = {
      "Power spectra show at which rates the charge beats, not where it lies. The scatter of their bands is a little "
      "larger than the errors say, so they do not count in the number."};
  for (const SampledDifference& d : c.deviation->lines)
    for (Plot& plot : plots_of(d, c))
      (is_impacts(d) ? impacts : is_over_time(d) ? rhythm : profile).plots.push_back(std::move(plot));
  PageSection frames{.heading = "Frame by frame, as a crowd"};
  frames.paragraphs = {"How often each value comes. No frame is compared with a frame."};
  frames.plots = distributions(c);
  std::vector<PageSection> all;
  for (PageSection* section : {&profile, &frames, &rhythm, &impacts})
    if (!section->plots.empty()) all.push_back(std::move(*section));
  return all;
}

// --- data of the map and of the paths

Json cells(const std::vector<double>& values, int digits) {
  Json out = Json::array();
  for (const double v : values) out.push_back(json_number(v, digits));
  return out;
}

Json map_json(const Deviation& d) {
  Json fields = Json::object();
  int n = 0;
  for (const SampledDifference& f : d.fields) {
    n = f.n;
    Json named = Json::array();
    for (const char s : f.significant) named.push_back(s != 0 ? 1 : 0);
    fields[f.name] = {
        {"a", cells(f.a, 4)},          {"ase", cells(f.a_se, 2)}, {"b", cells(f.b, 4)}, {"bse", cells(f.b_se, 2)},
        {"d", cells(f.difference, 4)}, {"se", cells(f.se, 2)},    {"z", cells(f.z, 3)}, {"named", named}};
  }
  return {{"n", n}, {"fields", fields}};
}

Json points(const std::vector<double>& x, const std::vector<double>& y, double radius) {
  Json out = Json::array();
  for (std::size_t i = 0; i < x.size(); ++i)
    out.push_back({json_number(x[i] / radius, 4), json_number(y[i] / radius, 4)});
  return out;
}

Json side_json(const ComparedSource& side) {
  const ChargeMotion& m = *side.motion;
  std::vector<double> x, y;
  for (const SurfacePoint& p : m.surface) x.push_back(p.x), y.push_back(p.y);
  Json paths = Json::array();
  for (const BallPath& p : side.paths)
    paths.push_back({{"ball", p.ball},
                     {"share", json_number(p.share, 3)},
                     {"time", cells(p.time, 5)},
                     {"points", points(p.x, p.y, m.mill_radius)}});
  const auto levels = [](const Estimate& half, const Estimate& bulk, const Estimate& outer) {
    return Json{json_number(half.value, 6), json_number(bulk.value, 6), json_number(outer.value, 6)};
  };
  return {{"toe", levels(m.toe_deg, m.toe_bulk_deg, m.toe_outer_deg)},
          {"shoulder", levels(m.shoulder_deg, m.shoulder_bulk_deg, m.shoulder_outer_deg)},
          {"surface", std::isfinite(m.mill_radius) ? points(x, y, m.mill_radius) : Json::array()},
          {"paths", paths}};
}

// --- words

std::string title_of(const Deviation& d) {
  switch (d.verdict) {
    case Verdict::kAgree:
      return "They agree";
    case Verdict::kDiffer:
      return "They differ";
    case Verdict::kUnknown:
      break;
  }
  return "It cannot be said whether they agree";
}

// The title has said whether they agree.
std::string after_verdict(const std::string& sentence) {
  const std::size_t end = sentence.find(". ");
  return end == std::string::npos ? sentence : sentence.substr(end + 2);
}

std::string sides_html(const Comparison& c) {
  const auto side = [](const char* name, const char* style, const ChargeMotion& m) {
    std::string what = fmt::format("{}, {} frames", name_of_kind(m.source), m.frames);
    if (std::isfinite(m.speed_rpm.value)) what += fmt::format(", {:.4g} rev/min", m.speed_rpm.value);
    return fmt::format("<dt class=\"{}\">{}</dt><dd>{} ({})</dd>", style, name, escaped(file_name(m)), escaped(what));
  };
  return side("A", "a", *c.a.motion) + side("B", "b", *c.b.motion);
}

std::string key(const std::string& term, const std::string& value, const std::string& beside) {
  return "<div><dt>" + term + "</dt><dd>" + value + "<small>" + beside + "</small></dd></div>";
}

const Difference* find(const Deviation& d, const char* name) {
  for (const Difference& one : d.differences)
    if (one.name == name) return &one;
  return nullptr;
}

std::string keys_html(const Deviation& d) {
  std::string out;
  if (std::isfinite(d.chi))
    out += key("The number", fmt::format("{:.2f}", d.chi),
               fmt::format("1 is agreement; 99 of 100 pairs of equal mills stay below {:.2f}", d.chi_limit));
  for (const auto& [name, words] :
       {std::pair{"toe_deg", "Toe, B − A"}, {"shoulder_deg", "Shoulder, B − A"}, {"torque_N_m", "Torque, B − A"}}) {
    const Difference* one = find(d, name);
    if (one == nullptr || std::isnan(one->difference)) continue;
    const bool deg = one->unit == "deg";
    out +=
        key(words, with_error({one->difference, one->se}) + (deg ? "°" : "\u00a0N\u00a0m"),
            std::isnan(one->z) ? "without a standard error"
                               : fmt::format("z = {}{}", number(one->z, 1), one->significant ? ", beyond chance" : ""));
  }
  for (const SampledDifference& f : d.fields)
    if (f.name == "occupancy")
      out += key("Cells of other occupancy", fmt::format("{} of {}", f.beyond_chance, f.compared),
                 f.where.empty() ? "beyond chance" : "beyond chance, most " + escaped(f.where));
  for (const Agreement& of : d.agreements)
    out += key("Root mean square z, " + of.name, fmt::format("{:.2f}", std::sqrt(of.mean_square)),
               fmt::format("over {}", of.compared));
  return out;
}

std::string rows_html(const Deviation& d) {
  std::string rows;
  for (const bool conditions : {false, true})
    for (const Difference& one : d.differences) {
      if (one.is_condition != conditions) continue;
      const auto shown = [&](const Estimate& e) { return e.se > 0 ? with_error(e) : number(e.value, one.se); };
      const char* style = one.significant ? " class=\"far\"" : conditions ? " class=\"condition\"" : "";
      const std::string apart = std::isnan(one.difference) ? escaped(one.note)
                                                           : with_error({one.difference, one.se}) +
                                                                 (one.note.empty() ? "" : ", " + escaped(one.note));
      rows +=
          fmt::format("<tr{}><th scope=\"row\">{}{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                      style, escaped(words_for(one.name)), conditions ? " (condition)" : "", escaped(one.unit),
                      shown(one.a), shown(one.b), apart, number(one.z, 1));
    }
  return rows;
}

std::string fact(const std::string& term, const std::string& value) {
  return "<dt>" + term + "</dt><dd>" + value + "</dd>";
}

std::string facts_html(const Comparison& c) {
  std::string out = fact("Program", "tumble " + escaped(c.version));
  for (const auto& [m, name] : {std::pair{c.a.motion, "A"}, {c.b.motion, "B"}}) {
    out += fact(name, escaped(m->origin) + fmt::format(" ({})", name_of(m->source)));
    out += fact(std::string(name) + ", frames",
                fmt::format("{} at {} per second", m->frames, number(m->frames_per_second)));
    if (std::isfinite(m->mill_radius))
      out += fact(std::string(name) + ", mill",
                  fmt::format("{:.4g} m inside the shell, {} lifters", 2 * m->mill_radius, m->lifter_count));
  }
  return out;
}

std::vector<std::string> caveats_of(const Comparison& c) {
  std::vector<std::string> all = c.deviation->caveats;
  for (const auto& [m, name] : {std::pair{c.a.motion, "A: "}, {c.b.motion, "B: "}})
    for (const std::string& text : m->caveats) all.push_back(name + text);
  return all;
}

std::string picture(const ComparedSource& side, const ChargeMotion& other, const char* label) {
  if (!(side.shape.radius > 0) || side.motion->field.n == 0) return "<p>No picture: the mill’s size is not known.</p>";
  return mill_picture(side.shape, *side.motion, &other, label);
}

std::string films_html(const Comparison& c) {
  const bool a = !c.a.film.file.empty(), b = !c.b.film.file.empty();
  if (!a && !b) return "";
  std::string out = fmt::format("<section id=\"films\" class=\"films\">\n<h2>{}</h2>\n<div class=\"pair\">\n",
                                a && b ? "Side by side" : "The charge in motion");
  for (const auto& [film, name, style] : {std::tuple{&c.a.film, "A", "truth"}, {&c.b.film, "B", "found"}})
    if (!film->file.empty())
      out += fmt::format("<figure class=\"{}\">{}<figcaption><b>{}.</b> {}</figcaption></figure>\n", style,
                         video_html(film->file, "muted playsinline"), name, escaped(film->caption));
  out +=
      "</div>\n<div class=\"player\"><button id=\"film-play\" type=\"button\">Play</button>"
      "<input id=\"film-time\" type=\"range\" min=\"0\" max=\"1000\" value=\"0\" aria-label=\"Place in the films\">"
      "<output id=\"film-clock\">0.00 s</output><label>Speed <select id=\"film-speed\"><option "
      "value=\"0.25\">¼</option>"
      "<option value=\"0.5\">½</option><option value=\"1\" selected>1</option><option "
      "value=\"2\">2</option></select></label></div>\n";
  if (!c.film_note.empty()) out += "<p class=\"note\">" + escaped(c.film_note) + "</p>\n";
  return out + "</section>\n";
}

std::string map_caption(const Deviation& d) {
  for (const SampledDifference& f : d.fields)
    if (f.name == "occupancy")
      return fmt::format(
          "Framed: beyond chance, {} of {} cells of occupancy; among equal mills no cell would be framed "
          "in 99 of 100 comparisons. Neighbouring cells are full and empty together; the procedure "
          "(Benjamini and Hochberg) allows for that.",
          f.beyond_chance, f.compared);
  return "";
}

}  // namespace

std::string comparison_page(const Comparison& c) {
  const Deviation& d = *c.deviation;
  std::string sections;
  Json plots = Json::array();
  for (const PageSection& section : plot_sections(c)) {
    const std::string id = fmt::format("compare-{}", plots.size());
    sections += section_html(section, id);
    for (Json& plot : plots_json(section.plots, id)) plots.push_back(std::move(plot));
  }
  const double tip = c.a.motion->tip_radius / c.a.motion->mill_radius;
  const Json data = {{"plots", plots},
                     {"map", map_json(d)},
                     {"sides", {side_json(c.a), side_json(c.b)}},
                     {"tip", std::isfinite(tip) ? tip : 1.0},
                     {"path_dots", kPathDots},
                     {"film_rate", c.film_rate},
                     {"film_slow", c.film_slow}};
  const std::string title = title_of(d) + ": " + file_name(*c.a.motion) + " and " + file_name(*c.b.motion);
  return filled(compare_html, {{"top", std::string(top_html)},
                               {"head", head_html(title, "; media-src data: blob:")},
                               {"title", escaped(title)},
                               {"lead", escaped(after_verdict(d.sentence))},
                               {"sides", sides_html(c)},
                               {"caveats", caveats_html(caveats_of(c))},
                               {"keys", keys_html(d)},
                               {"a_picture", picture(c.a, *c.b.motion, "Mean charge of A")},
                               {"b_picture", picture(c.b, *c.a.motion, "Mean charge of B")},
                               {"map_caption", escaped(map_caption(d))},
                               {"films", films_html(c)},
                               {"sections", sections},
                               {"paths_hidden", c.a.paths.empty() && c.b.paths.empty() ? " hidden" : ""},
                               {"path_dots", fmt::format("{:g} s", kPathDots)},
                               {"rows", rows_html(d)},
                               {"facts", facts_html(c)},
                               {"footer", footer_html(c.version)},
                               {"data", script_json(data)},
                               {"uplot_js", std::string(uplot_js)},
                               {"plots_js", std::string(plots_js)},
                               {"maps_js", std::string(maps_js)},
                               {"script", std::string(compare_js)}});
}

}  // namespace tumble::io
