#include "io/report/run_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/effects.h"
#include "core/units.h"
#include "io/report/html.h"

namespace tumble::io::report {
namespace {

using Column = std::vector<double>;

double sum(const Column& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

std::string percent(double share) { return number(100 * share, 5); }  // to a tenth

struct Words {
  const char* key;
  const char* words;
};
constexpr Words kCauses[] = {
    {"ball_ball_normal", "Ball on ball, along the normal"},
    {"ball_ball_sliding", "Ball on ball, sliding"},
    {"ball_wall_normal", "Ball on wall, along the normal"},
    {"ball_wall_sliding", "Ball on wall, sliding"},
    {"rolling", "Rolling resistance"},
    {"fluid_drag", "Drag of the fluid"},
    {"slurry_pool", "Drag in the pool"},
    {"end_walls", "Friction of the end walls"},
};
constexpr const char* kFaceWords[] = {"shell between the lifters", "leading faces", "tops", "trailing faces"};
static_assert(std::size(kFaceWords) == kFaceNames.size());

std::string cause_in_words(const std::string& cause) {
  for (const Words& w : kCauses)
    if (cause == w.key) return w.words;
  return cause;
}

// --- where the power goes

PageTable dissipation_table(const RunReport& r) {
  const RunSummary& s = *r.summary;
  double drive = s.stored_power;
  for (const Estimate& d : s.dissipation) drive += d.value;
  PageTable table{.header = {"Lost to", "W", "% of power"}};
  const std::size_t causes = std::min(s.dissipation.size(), r.setup->dissipation_causes.size());
  for (std::size_t c = 0; c < causes; ++c)
    table.rows.push_back({cause_in_words(r.setup->dissipation_causes[c]), with_error(s.dissipation[c]),
                          percent(s.dissipation[c].value / drive)});
  table.rows.push_back({"Stored meanwhile", number(s.stored_power, s.power.se), percent(s.stored_power / drive)});
  table.note =
      "Of one slice, mean over the written frames. The wall is shell and lifters. Along the normal the dashpots lose, "
      "in "
      "impacts and in contacts that stay closed alike. Stored: motion, height, springs.";
  return table;
}

// Power per bin: number times the bin's middle energy, which is known to a sixth.
Column power_of(const ImpactSpectrum& s, const Column& rates) {
  Column power;
  for (std::size_t b = 0; b < rates.size(); ++b) power.push_back(rates[b] * std::sqrt(s.edges_J[b] * s.edges_J[b + 1]));
  return power;
}

// The energy above which half of the power goes; NaN where there is none.
double half_power_energy(const ImpactSpectrum& s, const Column& rates) {
  const Column power = power_of(s, rates);
  const double half = sum(power) / 2;
  double below = 0;
  for (std::size_t b = 0; b < power.size(); ++b) {
    if (below + power[b] >= half && power[b] > 0)
      return s.edges_J[b] * std::pow(s.edges_J[b + 1] / s.edges_J[b], (half - below) / power[b]);
    below += power[b];
  }
  return kNotGiven;
}

// One kind of impacts: by all the energy lost in them, by its normal and by its tangential part.
struct Kind {
  const char* name;
  const Column &total, &normal, &tangential;
};

bool has_bins(const ImpactSpectrum& s) {
  if (s.edges_J.size() < 2) return false;
  for (const Column* c : {&s.ball_ball, &s.ball_wall, &s.ball_ball_normal, &s.ball_ball_tangential, &s.ball_wall_normal,
                          &s.ball_wall_tangential})
    if (c->size() + 1 != s.edges_J.size()) return false;
  return sum(s.ball_ball) + sum(s.ball_wall) > 0;
}

// From the first bin with an impact to behind the last, the same for every plot.
std::pair<std::size_t, std::size_t> seen_bins(const ImpactSpectrum& s) {
  const auto empty = [&](std::size_t b) { return s.ball_ball[b] + s.ball_wall[b] == 0; };
  std::size_t begin = 0, end = s.ball_ball.size();
  while (begin < end && empty(begin)) ++begin;
  while (end > begin && empty(end - 1)) --end;
  return {begin, end};
}

Plot spectrum_plot(const ImpactSpectrum& s, const Kind& kind, bool as_power) {
  const auto [begin, end] = seen_bins(s);
  const auto cut = [&, begin = begin, end = end](const Column& v) {
    return Column(v.begin() + static_cast<std::ptrdiff_t>(begin), v.begin() + static_cast<std::ptrdiff_t>(end));
  };
  Column edges(s.edges_J.begin() + static_cast<std::ptrdiff_t>(begin),
               s.edges_J.begin() + static_cast<std::ptrdiff_t>(end) + 1);
  Plot plot{.title = fmt::format("{}, {}", as_power ? "Power by energy of impact" : "Impacts by energy", kind.name),
            .x_label = "energy lost in an impact, J",
            .y_label = as_power ? "W per bin" : "impacts per second and bin",
            .x_log = true,
            .y_log = !as_power,
            .y_from_zero = as_power};
  const auto add = [&](const char* label, const Column& rates, bool dashed) {
    plot.series.push_back({.label = label,
                           .x = edges,
                           .y = cut(as_power ? power_of(s, rates) : rates),
                           .mark = PlotMark::kSteps,
                           .dashed = dashed});
  };
  add("all", kind.total, false);
  add("normal part", kind.normal, false);
  add("tangential part", kind.tangential, true);
  if (as_power)
    if (const double half = half_power_energy(s, kind.total); std::isfinite(half))
      plot.upright = {{half, "half of the power lies above"}};
  return plot;
}

std::string half_in_words(const ImpactSpectrum& s) {
  std::string out;
  const auto add = [&](const char* name, const Column& rates) {
    const double half = half_power_energy(s, rates);
    if (!std::isfinite(half)) return;
    out += fmt::format("{}alf of the power lost in impacts of {} goes in impacts of more than {} J",
                       out.empty() ? "H" : "; h", name, fmt::format("{:.2g}", half));
  };
  add("ball on ball", s.ball_ball);
  add("ball on wall", s.ball_wall);
  return out + ".";
}

PageSection power_section(const RunReport& r) {
  PageSection section{.heading = "Where the power goes"};
  if (!r.summary->dissipation.empty()) section.tables = {dissipation_table(r)};
  const ImpactSpectrum& s = r.result->spectrum;
  if (!has_bins(s)) return section;
  section.paragraphs = {half_in_words(s)};
  const Kind between{"ball on ball", s.ball_ball, s.ball_ball_normal, s.ball_ball_tangential};
  const Kind at_wall{"ball on wall", s.ball_wall, s.ball_wall_normal, s.ball_wall_tangential};
  for (const bool as_power : {true, false})
    for (const Kind& kind : {between, at_wall}) section.plots.push_back(spectrum_plot(s, kind, as_power));
  section.plots[0].caption =
      "Number of impacts times the middle energy of their bin: the bins are even on this axis, so areas are powers.";
  section.plots[2].caption =
      "An impact lasts from first touch to parting. Each curve sorts the impacts by its own part of the energy lost.";
  return section;
}

// --- impacts and falls

// Bins round the shell from the cut on, for one row of values.
PlotSeries round_the_shell(const Column& edges, const Column& values, int cut, const std::string& label) {
  PlotSeries s{.label = label, .mark = PlotMark::kSteps};
  const std::size_t n = values.size();
  std::size_t first = 0;
  while (first < n && edges[first] < cut) ++first;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t b = (first + k) % n;
    s.x.push_back(edges[b] + (first + k >= n ? 360 : 0));
    s.y.push_back(values[b]);
  }
  if (n > 0) s.x.push_back(s.x.front() + 360);
  return s;
}

PageTable faces_table(const ImpactPlaces& p) {
  PageTable table{.title = "Impacts of balls on the shell", .header = {"Part", "per second", "W", "% of these W"}};
  double power = 0;
  for (const Column& face : p.power) power += sum(face);
  for (std::size_t f = 0; f < kFaceNames.size(); ++f)
    if (sum(p.frequency[f]) > 0)
      table.rows.push_back(
          {kFaceWords[f], number(sum(p.frequency[f])), number(sum(p.power[f])), percent(sum(p.power[f]) / power)});
  table.note =
      "By the place of the first touch; the power is all that is lost until the ball parts, along the normal and by "
      "sliding. The leading face looks in the direction of rotation.";
  return table;
}

PageSection impacts_section(const RunReport& r, int cut) {
  PageSection section{.heading = "Impacts and falls"};
  const ImpactPlaces& p = r.result->places;
  const std::size_t bins = p.angle_edges_deg.empty() ? 0 : p.angle_edges_deg.size() - 1;
  if (bins > 0 && std::all_of(p.power.begin(), p.power.end(), [&](const Column& c) { return c.size() == bins; })) {
    Plot where{.title = "Where on the shell",
               .x_label = "angle in the lab, degrees",
               .y_label = fmt::format("W per {:.3g}°", 360 / double(bins)),
               .y_from_zero = true,
               .x_is_direction = true,
               .caption =
                   "Power lost in impacts on the shell and its lifters by the angle (counter-clockwise from 3 "
                   "o’clock) of the first touch."};
    for (std::size_t f = 0; f < kFaceNames.size(); ++f)
      if (sum(p.frequency[f]) > 0)
        where.series.push_back(round_the_shell(p.angle_edges_deg, p.power[f], cut, kFaceWords[f]));
    if (!where.series.empty()) {
      section.tables = {faces_table(p)};
      section.plots.push_back(where);
    }
  }
  if (sum(p.lifter_frequency) > 0) {
    PlotSeries power{.label = "power", .y = p.lifter_power, .mark = PlotMark::kSteps};
    for (std::size_t k = 0; k <= p.lifter_power.size(); ++k) power.x.push_back(double(k) - 0.5);
    section.plots.push_back({.title = "By lifter",
                             .x_label = "lifter",
                             .y_label = "W",
                             .y_from_zero = true,
                             .series = {power},
                             .caption = "Power lost in impacts on each lifter’s own faces. Lifter 0 is at 3 o’clock "
                                        "at mill angle 0, the others follow counter-clockwise."});
  }
  const FallHeights& falls = r.result->falls;
  if (sum(falls.frequency) > 0 && falls.edges.size() == falls.frequency.size() + 1) {
    std::size_t end = falls.frequency.size();
    while (end > 1 && falls.frequency[end - 1] == 0) --end;
    PlotSeries s{.label = "falls", .mark = PlotMark::kSteps};
    s.x.assign(falls.edges.begin(), falls.edges.begin() + static_cast<std::ptrdiff_t>(end) + 1);
    s.y.assign(falls.frequency.begin(), falls.frequency.begin() + static_cast<std::ptrdiff_t>(end));
    section.plots.push_back({.title = "Fall heights",
                             .x_label = "height fallen, m",
                             .y_label = "falls per second and bin",
                             .y_log = true,
                             .series = {s},
                             .caption = "From the highest point of each flight to where the ball touches again. The "
                                        "first bin holds hops, and flights that end where they are highest."});
  }
  return section;
}

// --- fluid

PageSection fluid_section(const RunReport& r) {
  PageSection section{.heading = "Torque of fluid and pool on the charge"};
  const RunSummary& s = *r.summary;
  section.paragraphs = {"On average " + with_error(s.torque_external) +
                        " N\u00a0m about the axis. In a steady state the drive’s torque and this one together hold "
                        "the charge’s weight, " +
                        with_error(s.torque_closure) + " N\u00a0m."};
  section.plots = {{.x_label = "time, s",
                    .y_label = "torque, N m",
                    .tall = true,
                    .series = {{.label = "fluid and pool", .x = s.time, .y = s.external}},
                    .level = {{s.torque_external.value, "mean", s.torque_external.se}}}};
  return section;
}

// --- steady or not

PageSection trust_section(const RunReport& r) {
  PageSection section{.heading = "Can the averages be trusted?"};
  const RunSummary& s = *r.summary;
  section.paragraphs.push_back(
      r.result->steady
          ? "The mill was steady while the averages were taken: neither torque nor centre of mass drifted beyond what "
            "chance does, and no pocket between the lifters was filled or emptied."
          : "The mill was not shown to be steady while the averages were taken: see the remarks above the numbers.");
  const bool any = std::any_of(s.locked.begin(), s.locked.end(), [](double n) { return n > 0; });
  if (!any) {
    section.paragraphs.push_back("No ball was locked between the lifters for a whole revolution.");
    return section;
  }
  section.paragraphs.push_back(fmt::format(
      "At the end {:.0f} of {} balls had turned with the shell for more than a revolution. Below critical speed that "
      "is "
      "an artefact of the plane: balls wedge between two lifters, which in a mill with depth they rarely can, and no "
      "longer load the charge. A change of the pocket’s width by a millimetre can free them.",
      s.locked_balls, r.setup->balls.size()));
  section.plots = {{.x_label = "time, s",
                    .y_label = "locked balls",
                    .y_from_zero = true,
                    .tall = true,
                    .series = {{.label = "locked balls", .x = s.time, .y = s.locked}}}};
  return section;
}

// --- from one slice to the mill

std::string slices_in_words(const Config& c, double slices, double mass) {
  const std::vector<int> counts = class_counts(c);
  switch (slice_rule(c)) {
    case SliceRule::kGiven:
      return fmt::format("The file says that {:g} slices make up the mill (mill.slices).", slices);
    case SliceRule::kNoLength:
      return "The file gives no length (mill.length), so the slice stands for the mill.";
    case SliceRule::kThin:
      return fmt::format("The mill is {:g} m long, less than 1.5 mean ball diameters: one slice is the mill.",
                         c.mill.length);
    case SliceRule::kWeight:
      break;
  }
  return fmt::format(
      "The mill’s balls weigh as much as {:.4g} slices (Mishra & Rajamani 1992, p. 603): filling {:.4g} × shell area "
      "{:.4g} m² × length {:g} m × bulk density {:g} kg/m³ = {:.4g} kg, over {:.4g} kg in the slice. Motion along the "
      "axis and the end walls are not in it.",
      slices, filling_of(c, counts), kPi * c.mill.diameter * c.mill.diameter / 4, c.mill.length, c.charge.bulk_density,
      slices * mass, mass);
}

PageSection mill_section(const RunReport& r) {
  const RunSummary& s = *r.summary;
  PageSection section{.heading = "From one slice to the mill"};
  const double mass = sum(r.setup->balls.mass);
  section.paragraphs = {slices_in_words(r.setup->config, s.slices, mass)};
  PageTable table{.header = {"Quantity", "Unit", "One slice", "The mill"}};
  table.rows = {{"Slices", "", "1", fmt::format("{:.4g}", s.slices)},
                {"Balls’ mass", "kg", fmt::format("{:.4g}", mass), fmt::format("{:.4g}", mass * s.slices)},
                {"Torque", "N m", with_error(s.torque), with_error(s.mill_torque)},
                {"Power", "W", with_error(s.power), with_error(s.mill_power)}};
  table.note =
      "The errors are those of the slice’s averages, scaled; what the scheme itself leaves out is not in them.";
  section.tables = {table};
  return section;
}

// --- effects

std::string value_in_words(const Config& c, const Effect& effect, const EffectParameter& p) {
  if (!p.list) return fmt::format("{:g}", effect_value(c, effect.name, p.name));
  std::string out;
  for (const double v : effect_column(c, effect.name, p.name))
    out += (out.empty() ? "" : ", ") + fmt::format("{:g}", v);
  return out.empty() ? (p.is_column() ? "not given" : "all") : out;
}

PageSection effects_section(const Config& c) {
  PageSection section{.heading = "Effects that are on"};
  PageTable table{.header = {"Effect", "Parameter", "Unit", "Value", "Meaning"}};
  for (const Effect& effect : all_effects()) {
    if (!has_effect(c, effect.name)) continue;
    section.paragraphs.push_back(fmt::format("{}: {}.", effect.name, effect.summary));
    for (const EffectParameter& p : effect.parameters)
      table.rows.push_back({effect.name, p.name, p.unit, value_in_words(c, effect, p), p.meaning});
  }
  section.tables = {table};
  return section;
}

}  // namespace

std::vector<PageSection> run_sections(const RunReport& r, int cut_deg) {
  std::vector<PageSection> all;
  const auto add = [&](PageSection section) {
    if (!section.paragraphs.empty() || !section.plots.empty() || !section.tables.empty())
      all.push_back(std::move(section));
  };
  const auto& external = r.summary->external;
  if (std::any_of(external.begin(), external.end(), [](double v) { return std::abs(v) > 0; })) add(fluid_section(r));
  add(power_section(r));
  add(impacts_section(r, cut_deg));
  add(trust_section(r));
  add(mill_section(r));
  const auto effects = all_effects();
  if (std::any_of(effects.begin(), effects.end(), [&](const Effect& e) { return has_effect(r.setup->config, e.name); }))
    add(effects_section(r.setup->config));
  return all;
}

}  // namespace tumble::io::report
