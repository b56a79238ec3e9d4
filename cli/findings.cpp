#include "cli/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/version.h"

namespace tumble::cli {
namespace {

using diagnose::BallGroup;
using diagnose::BounceKind;
using diagnose::FavouredLaw;
using diagnose::LoadCellDrop;
using diagnose::RestitutionResult;
using diagnose::StiffnessGroup;
using Json = nlohmann::ordered_json;

// To as many digits as `unit`, a power of ten, leaves.
std::string rounded(double value, double unit) {
  const int decimals = std::max(0, static_cast<int>(std::lround(-std::log10(unit))));
  return fmt::format("{:.{}f}", std::round(value / unit) * unit, decimals);
}

// 4.46e5, 0.507: as people write it and as TOML takes it.
std::string scientific(double value, int digits) {
  std::string text = fmt::format("{:.{}g}", value, digits);
  if (const auto e = text.find("e+0"); e != std::string::npos) text.erase(e + 1, 2);
  return text;
}

std::string toml_number(double value, int digits = 3) {
  const std::string text = scientific(value, digits);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string shown(double value) { return std::isfinite(value) ? scientific(value, 4) : "–"; }

// "0.496 ± 0.012", "4.4e5 ± 1.1e5": two digits of the standard error, and no more of the value than it gives meaning
// to.
std::string shown(const Estimate& e, const char* unit = "") {
  const std::string tail = *unit ? std::string(" ") + unit : "";
  if (!std::isfinite(e.value)) return "–";
  if (!(e.se > 0) || !std::isfinite(e.se)) return shown(e.value) + tail;
  const bool large = std::abs(e.value) >= 1e5;
  const double scale = large ? std::pow(10, std::floor(std::log10(std::abs(e.value)))) : 1;
  const std::string power = large ? fmt::format("e{:.0f}", std::log10(scale)) : "";
  const double digit = std::pow(10, std::floor(std::log10(e.se / scale)) - 1);
  return rounded(e.value / scale, digit) + power + " ± " + rounded(e.se / scale, digit) + power + tail;
}

// Restitution to the digits that its error allows, at most three decimals.
std::string toml_restitution(const Estimate& e) { return fmt::format("{:.3f}", std::clamp(e.value, 0.001, 1.0)); }

std::string plus_minus(const Estimate& e) {
  return e.se > 0 && std::isfinite(e.se) ? "± " + scientific(e.se, 2) + ", " : "";
}

std::string counted(std::size_t n, const std::string& noun) {
  return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json json_of(const Estimate& e) { return {{"value", json_of(e.value)}, {"se", json_of(e.se)}}; }

const char* name_of(FavouredLaw law) {
  switch (law) {
    case FavouredLaw::kLinear:
      return "linear";
    case FavouredLaw::kHertz:
      return "hertz";
    case FavouredLaw::kNeither:
      return "neither";
    case FavouredLaw::kCannotTell:
      break;
  }
  return "cannot tell";
}

std::string particles_of(const StiffnessGroup& g) {
  if (g.particle_layers == 0 && g.particle_size.empty()) return "none (bare metal)";
  return counted(static_cast<std::size_t>(g.particle_layers), "layer") +
         (g.particle_size.empty() ? "" : " of " + g.particle_size + " mm");
}

std::string stiffness_lines(const StiffnessGroup& g, double stiffness) {
  return fmt::format("normal_stiffness = {}       # N/m, {}{}\ntangential_stiffness = {}   # N/m, 2/3 of it\n",
                     toml_number(stiffness), plus_minus({stiffness, stiffness * g.stiffness.se / g.stiffness.value}),
                     counted(g.drops.size(), "drop") + ", particles: " + particles_of(g),
                     toml_number(stiffness * diagnose::kTangentialShare));
}

std::string commented(const std::string& lines) {
  std::string out;
  for (std::size_t at = 0; at < lines.size();) {
    const auto end = lines.find('\n', at);
    out += "# " + lines.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return out;
}

// The group that MILL.toml gets: where there are particles in the mill balls hardly ever touch bare (p. 601).
std::size_t chosen_group(const std::vector<StiffnessGroup>& groups, int layers) {
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (layers < 0 ? groups[i].particle_layers > 0 : groups[i].particle_layers == layers) return i;
  return 0;
}

std::string stiffness_toml(const std::vector<StiffnessGroup>& groups, std::size_t chosen) {
  std::string out = "[contact]\n" + stiffness_lines(groups[chosen], groups[chosen].stiffness.value);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const StiffnessGroup& g = groups[i];
    if (i != chosen) out += "# or:\n" + commented(stiffness_lines(g, g.stiffness.value));
    if (g.law == FavouredLaw::kHertz)
      out += "# or, as these data favour:\n" +
             commented("law = \"hertz\"   # normal_stiffness: of two such balls that meet at 1 m/s\n" +
                       stiffness_lines(g, g.hertz_normal_stiffness));
  }
  return out;
}

io::Plot force_plot(const std::vector<StiffnessGroup>& groups) {
  io::Plot plot{.title = "Greatest force and displacement",
                .x_label = "displacement, m",
                .y_label = "force, N",
                .x_log = true,
                .y_log = true,
                .caption =
                    "Lines: F = k d, the linear spring with the stiffness found. A steeper row of points than its "
                    "line is a contact that stiffens."};
  for (std::size_t i = 0; i < groups.size(); ++i) {
    io::PlotSeries points{
        .label = particles_of(groups[i]), .mark = io::PlotMark::kPoints, .colour = static_cast<int>(i)};
    for (const LoadCellDrop& d : groups[i].drops) {
      points.x.push_back(d.max_displacement);
      points.y.push_back(d.max_force);
    }
    const auto [low, high] = std::minmax_element(points.x.begin(), points.x.end());
    io::PlotSeries line{.label = "k d", .x = {*low / 1.15, *high * 1.15}, .colour = static_cast<int>(i)};
    for (const double x : line.x) line.y.push_back(groups[i].stiffness.value * x);
    plot.series.push_back(points);
    plot.series.push_back(line);
  }
  return plot;
}

io::Plot stiffness_plot(const std::vector<StiffnessGroup>& groups) {
  io::Plot plot{.title = "Stiffness of each drop",
                .x_label = "fall height, m",
                .y_label = "stiffness, N/m",
                .y_log = true,
                .caption =
                    "Points: F/d. Bars: from 2E/d² to F²/(2E); they would shrink to the point if the contact were "
                    "a linear spring."};
  for (std::size_t i = 0; i < groups.size(); ++i) {
    io::PlotSeries s{.label = particles_of(groups[i]), .mark = io::PlotMark::kPoints, .colour = static_cast<int>(i)};
    for (const LoadCellDrop& d : groups[i].drops) {
      const diagnose::DropStiffness k = diagnose::stiffness_of(d);
      s.x.push_back(d.fall_height);
      s.y.push_back(k.by_slope);
      s.low.push_back(std::min(k.by_energy, k.by_force));
      s.high.push_back(std::max(k.by_energy, k.by_force));
    }
    plot.series.push_back(s);
  }
  return plot;
}

Json json_of(const StiffnessGroup& g) {
  Json drops = Json::array();
  for (const LoadCellDrop& d : g.drops) {
    const diagnose::DropStiffness k = diagnose::stiffness_of(d);
    drops.push_back({{"ball_mass_kg", d.ball_mass},
                     {"fall_height_m", d.fall_height},
                     {"force_over_displacement_N_per_m", k.by_slope},
                     {"by_energy_N_per_m", k.by_energy},
                     {"by_force_N_per_m", k.by_force},
                     {"given_N_per_m", json_of(d.given_stiffness)}});
  }
  return {{"particle_layers", g.particle_layers},
          {"particle_size_mm", g.particle_size},
          {"stiffness_N_per_m", json_of(g.stiffness)},
          {"by_energy_N_per_m", g.by_energy},
          {"by_force_N_per_m", g.by_force},
          {"exponent_by_height", json_of(g.exponent_by_height)},
          {"exponent_by_energy", json_of(g.exponent_by_energy)},
          {"law", name_of(g.law)},
          {"reason", g.reason},
          {"hertz_normal_stiffness_N_per_m", g.hertz_normal_stiffness},
          {"drops", drops}};
}

// Where the source prints a stiffness of its own that is not what its forces and displacements give.
void compare_with_given(const std::vector<StiffnessGroup>& groups, Findings& f) {
  double low = INFINITY, high = -INFINITY;
  for (const StiffnessGroup& g : groups)
    for (const LoadCellDrop& d : g.drops) {
      if (!std::isfinite(d.given_stiffness)) continue;
      const double ratio = d.given_stiffness / diagnose::stiffness_of(d).by_slope;
      low = std::min(low, ratio);
      high = std::max(high, ratio);
    }
  if (low < 0.98 || high > 1.02)
    f.caveats.push_back(fmt::format(
        "the file's own stiffness is {:.2f} to {:.2f} times force over displacement, and was not used", low, high));
}

std::string size_text(const BallGroup& g, BounceKind kind) {
  std::string out;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  if (std::isfinite(g.ball_radius)) add(fmt::format("{:.4g} m radius", g.ball_radius));
  if (std::isfinite(g.ball_mass)) add(fmt::format("{:.4g} kg", g.ball_mass));
  if (kind == BounceKind::kPendulum && std::isfinite(g.target_mass)) out += fmt::format(" on {:.4g} kg", g.target_mass);
  return out.empty() ? "all balls" : out;
}

io::Plot restitution_plot(const RestitutionResult& r) {
  io::Plot plot{.title = "Restitution of each impact",
                .x_label = "impact speed, m/s",
                .y_label = "restitution e",
                .tall = true,
                .caption = "Level line: mean, with one standard error to each side."};
  io::PlotSeries points{.label = "measured", .mark = io::PlotMark::kPoints, .colour = 0};
  double low = INFINITY, high = 0;
  for (const diagnose::Impact& impact : r.impacts) {
    points.x.push_back(impact.speed);
    points.y.push_back(impact.restitution.value);
    points.se.push_back(impact.restitution.se);
    low = std::min(low, impact.speed);
    high = std::max(high, impact.speed);
  }
  plot.series.push_back(points);
  plot.level = {{r.mean.value, "mean", r.mean.se}};
  if (r.falling) {
    io::PlotSeries curve{.label = "e₀ (1 − drop (1 − exp(−v/vₑ)))", .colour = 1};
    for (int i = 0; i <= 60; ++i) {
      const double v = low + (high - low) * i / 60;
      curve.x.push_back(v);
      curve.y.push_back(r.falling->at_rest.value *
                        (1 - r.falling->drop.value * (1 - std::exp(-v / r.falling->speed.value))));
    }
    plot.series.push_back(curve);
  }
  return plot;
}

std::size_t width_of(const std::string& text) {  // in characters
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string text_of(const io::PageTable& table) {
  std::vector<std::vector<std::string>> all{table.header};
  all.insert(all.end(), table.rows.begin(), table.rows.end());
  std::vector<std::size_t> widths(table.header.size());
  for (const auto& row : all)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  std::string out;
  for (const auto& row : all) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 < row.size()) line.append(widths[i] - width_of(row[i]) + 3, ' ');
    }
    out += line + "\n";
  }
  return out + (table.note.empty() ? "" : table.note + "\n");
}

std::string with_slope(const char* of, const Estimate& slope, bool matters, const char* unit) {
  if (!std::isfinite(slope.value)) return "";
  return fmt::format("with {}: de = {} {}{}", of, shown(slope), unit, matters ? "" : ", none beyond its error");
}

}  // namespace

Findings findings_of(const std::vector<StiffnessGroup>& groups, int layers, double restitution) {
  Findings f;
  f.kind = "Load cell";
  const std::size_t chosen = chosen_group(groups, layers);
  const StiffnessGroup& best = groups[chosen];
  f.title = "Contact stiffness " + shown(best.stiffness, "N/m") + ", particles: " + particles_of(best);
  f.lines.push_back(
      "k = F/d, which lies between 2E/d² (right overlap) and F²/(2E) (right force), E = m g (h + d); the standard "
      "error "
      "holds the drops' scatter and how far these disagree.");
  io::PageTable table{
      .title = "Stiffness",
      .header = {"particles between", "drops", "k, N/m", "2E/d²", "F²/(2E)", "n by heights", "n by energy", "favours"},
      .note =
          "n: exponent of F ~ dⁿ, 1 linear, 1.5 Hertz; from the growth of F and d with the fall "
          "height, and from Fd/E - 1 of each drop alone. ± is one standard error."};
  Json list = Json::array();
  for (const StiffnessGroup& g : groups) {
    table.rows.push_back({particles_of(g), std::to_string(g.drops.size()), shown(g.stiffness), shown(g.by_energy),
                          shown(g.by_force), shown(g.exponent_by_height), shown(g.exponent_by_energy),
                          std::string(name_of(g.law))});
    f.lines.push_back("Particles " + particles_of(g) + ": " + name_of(g.law) + " (" + g.reason + ").");
    if (g.drops.size() == 1)
      f.caveats.push_back("a single drop with particles " + particles_of(g) +
                          ": its error is only the disagreement of the three numbers");
    list.push_back(json_of(g));
  }
  f.tables.push_back(table);
  compare_with_given(groups, f);
  f.plots = {force_plot(groups), stiffness_plot(groups)};
  f.toml = stiffness_toml(groups, chosen);
  f.json = {{"experiment", "load-cell"}, {"groups", list}};
  if (restitution > 0) {
    io::PageTable damping{.title = "Damping constant (eq. 13)",
                          .header = {"ball, kg", "k, N/m", "C, N s/m"},
                          .note = fmt::format("Ball against wall at e = {:.4g}: the effective mass is the ball's. The "
                                              "simulator works C out itself from restitution and stiffness.",
                                              restitution)};
    std::vector<double> masses;
    for (const LoadCellDrop& d : best.drops)
      if (std::find(masses.begin(), masses.end(), d.ball_mass) == masses.end()) masses.push_back(d.ball_mass);
    Json damped = Json::array();
    for (const double m : masses) {
      const Estimate c = diagnose::damping_constant({restitution, kNotGiven}, best.stiffness, m);
      damping.rows.push_back({shown(m), shown(best.stiffness), shown(c)});
      damped.push_back({{"ball_mass_kg", m}, {"damping_N_s_per_m", json_of(c)}});
    }
    f.tables.push_back(damping);
    f.json["damping"] = damped;
  }
  f.json["mill_toml"] = f.toml;
  f.json["caveats"] = f.caveats;
  return f;
}

Findings findings_of(const RestitutionResult& r, BounceKind kind, double stiffness) {
  const bool drop = kind == BounceKind::kDrop;
  Findings f;
  f.kind = drop ? "Drop test" : "Pendulum";
  const std::string impacts = counted(r.impacts.size(), "impact");
  f.title = std::string(drop ? "Ball on wall" : "Ball on ball") + ": restitution " + shown(r.mean);
  f.lines.push_back(impacts + ", " + (drop ? "e = √(h₂/h₁)." : "e = (1 + m₂/m₁) √(h₂/h₁) − 1."));
  for (const std::string& line : {with_slope("impact speed", r.slope_speed, r.speed_matters, "per m/s"),
                                  with_slope("ball radius", r.slope_size, r.size_matters, "per m")})
    if (!line.empty()) f.lines.push_back("Change of restitution " + line + ".");
  if (r.falling)
    f.lines.push_back(fmt::format("It falls with speed: e₀ = {}, drop = {}, over vₑ = {} (effect impact_restitution).",
                                  shown(r.falling->at_rest), shown(r.falling->drop), shown(r.falling->speed, "m/s")));
  else
    f.lines.push_back(std::string("No e(v): ") + r.why_not_falling + ".");

  const bool damped = stiffness > 0;
  io::PageTable table{.title = "Restitution", .header = {"balls", "impacts", "e"}, .note = "± is one standard error."};
  if (damped) {
    table.header.push_back("C, N s/m");
    table.note +=
        fmt::format(" C: damping constant of eq. 13 at {} N/m and the pair's effective mass.", shown(stiffness));
  }
  Json groups = Json::array();
  for (const BallGroup& g : r.groups) {
    table.rows.push_back({size_text(g, kind), std::to_string(g.impacts), shown(g.restitution)});
    if (damped) table.rows.back().push_back(shown(g.damping));
    groups.push_back({{"ball_mass_kg", json_of(g.ball_mass)},
                      {"ball_radius_m", json_of(g.ball_radius)},
                      {"target_mass_kg", json_of(g.target_mass)},
                      {"impacts", g.impacts},
                      {"restitution", json_of(g.restitution)},
                      {"damping_N_s_per_m", json_of(g.damping)}});
  }
  if (r.groups.size() > 1) {
    table.rows.push_back({"together", std::to_string(r.impacts.size()), shown(r.mean)});
    if (damped) table.rows.back().push_back("–");
  }
  f.tables.push_back(table);
  if (damped && !std::isfinite(r.groups.front().damping.value))
    f.caveats.push_back("no damping constant: the data name no mass of the balls");
  if (!std::isfinite(r.mean.se)) f.caveats.push_back("a single impact without uncertainties: its error is not known");
  if (r.mean.value > 1) f.caveats.push_back("the mean is above 1, which no impact can be; MILL.toml gets 1");
  if (!(r.mean.value > 0)) f.caveats.push_back("the mean is not above 0; MILL.toml gets the least it takes");
  if (r.speed_matters)
    f.caveats.push_back("restitution changes with impact speed: the mean stands for speeds like those of the data");
  if (r.size_matters) f.caveats.push_back("restitution changes with the balls' size: the mean stands for such a mix");

  f.plots = {restitution_plot(r)};
  const std::string section = drop ? "[contact.wall]\n" : "[contact]\n";
  f.toml = section + "restitution = " + toml_restitution(r.mean) + "   # " + plus_minus(r.mean) + impacts + "\n";
  if (r.falling)
    f.toml += "# or, falling with the speed of the impact (at every contact):\n" +
              commented("restitution = " + toml_restitution(r.falling->at_rest) +
                        "\n[effects.impact_restitution]\ndrop = " + toml_number(r.falling->drop.value) +
                        "\nimpact_speed = " + toml_number(r.falling->speed.value) + "   # m/s\n");
  f.json = {{"experiment", drop ? "drop" : "pendulum"},
            {"impacts", r.impacts.size()},
            {"restitution", json_of(r.mean)},
            {"groups", groups},
            {"slope_per_m_s", json_of(r.slope_speed)},
            {"slope_per_m_radius", json_of(r.slope_size)},
            {"impact_restitution", nullptr},
            {"mill_toml", f.toml},
            {"caveats", f.caveats}};
  if (r.falling)
    f.json["impact_restitution"] = {{"restitution", json_of(r.falling->at_rest)},
                                    {"drop", json_of(r.falling->drop)},
                                    {"impact_speed_m_s", json_of(r.falling->speed)}};
  return f;
}

std::string text_of(const Findings& f) {
  std::string out = f.title + "\n";
  for (const std::string& line : f.lines) out += line + "\n";
  for (const io::PageTable& table : f.tables) out += "\n" + text_of(table);
  return out + "\n" + f.toml;
}

io::PlotPage page_of(const Findings& f) {
  io::PlotPage page{.kind = f.kind, .title = f.title, .caveats = f.caveats, .version = kVersion};
  page.lead = f.lines.front();
  io::PageSection found{.heading = "What was found", .plots = f.plots, .tables = f.tables};
  found.paragraphs.assign(f.lines.begin() + 1, f.lines.end());
  page.sections = {found, {.heading = "Lines for MILL.toml", .code = f.toml}};
  return page;
}

}  // namespace tumble::cli
