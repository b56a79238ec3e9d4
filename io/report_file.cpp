#include "io/report_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "core/angle.h"
#include "core/error.h"
#include "core/mill_shape.h"
#include "core/motion_quantities.h"
#include "io/json_number.h"
#include "io/output.h"
#include "io/report/embedded.h"
#include "io/report/figure.h"
#include "io/report/html.h"
#include "io/report/mill_picture.h"
#include "io/report/run_sections.h"
#include "io/report/section.h"

namespace tumble::io {
namespace fs = std::filesystem;
using namespace report;
namespace {

constexpr std::uintmax_t kLargestEmbedded = 64u << 20;  // [bytes]; a larger film stays beside the report

const char* adjective(LifterProfile profile) {
  switch (profile) {
    case LifterProfile::kRectangle:
      return "rectangular ";
    case LifterProfile::kTriangle:
      return "triangular ";
    case LifterProfile::kTrapezoid:
      return "trapezoidal ";
    case LifterProfile::kWave:
      return "wave-shaped ";
    case LifterProfile::kPolygon:
      return "specially shaped ";
    case LifterProfile::kSwivel:
      return "swivel ";
    case LifterProfile::kNone:
      break;
  }
  return "";
}

std::string lifters_of(const Mill& mill) {
  if (mill.lifters.profile == LifterProfile::kNone || mill.lifters.count == 0) return "without lifters";
  return fmt::format("with {} {}lifters", mill.lifters.count, adjective(mill.lifters.profile));
}

std::string title_of(const Config& c) {
  return fmt::format("A mill of {:.4g} m {} at {:.3g} of critical speed", c.mill.diameter, lifters_of(c.mill),
                     speed_fraction(c.mill));
}

std::string degrees_of(const Estimate& e) { return std::isfinite(e.value) ? with_error(e) + "°" : "not found"; }

// The report's first sentences: what was run and what was found.
std::string lead_of(const RunReport& r) {
  const Config& c = r.setup->config;
  std::string text = fmt::format(
      "{} balls were tumbled for {:.4g} revolutions, after {:.4g} of spin-up, at {:.3g} of critical speed "
      "({:.4g} rev/min) in a mill of {:.4g} m {}.",
      r.setup->balls.size(), c.run.revolutions, r.result->spin_up_revolutions, speed_fraction(c.mill),
      speed_rpm(c.mill), c.mill.diameter, lifters_of(c.mill));
  if (std::isfinite(r.truth->torque.value))
    text += " To turn one slice took " + with_error(r.truth->torque) + " N\u00a0m.";
  const Estimate &toe = r.film->toe_deg, &shoulder = r.film->shoulder_deg;
  if (!std::isfinite(toe.value) || !std::isfinite(shoulder.value))
    return text + " The film alone did not give both toe and shoulder.";
  text += fmt::format(" From the rendered film alone, the toe was found at {} and the shoulder at {}", degrees_of(toe),
                      degrees_of(shoulder));
  const double off_toe = std::abs(wrap_180(toe.value - r.truth->toe_deg.value));
  const double off_shoulder = std::abs(wrap_180(shoulder.value - r.truth->shoulder_deg.value));
  if (std::isfinite(off_toe) && std::isfinite(off_shoulder))
    text += fmt::format(", {:.1f}° and {:.1f}° from where the simulation has them", off_toe, off_shoulder);
  return text + ".";
}

std::string caveats_of(const RunReport& r) {
  std::vector<std::string> all;
  const auto add = [&](const std::string& text) {
    if (!text.empty() && std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
  };
  add(r.result->caveat);
  if (!r.result->steady && r.result->caveat.empty())
    add("The averages still drifted while they were taken: more spin-up is needed, or spin_up = \"auto\".");
  for (const auto& caveat : r.truth->caveats) add(caveat);
  for (const auto& caveat : r.film->caveats) add("Film: " + caveat);
  return caveats_html(all);
}

std::string key(const std::string& term, const std::string& value, const std::string& beside) {
  return "<div><dt>" + term + "</dt><dd>" + value + "<small>" + beside + "</small></dd></div>";
}

std::string keys_of(const RunReport& r) {
  const ChargeMotion &truth = *r.truth, &film = *r.film;
  std::string out;
  const double gap = std::abs(truth.torque.value / truth.torque_closure.value - 1);
  out += key("Torque of one slice", with_error(truth.torque) + " N\u00a0m",
             "from the charge’s weight " + number(truth.torque_closure.value, truth.torque.se) + " N\u00a0m" +
                 (std::isfinite(gap) ? fmt::format(", {:.2g} % apart", 100 * gap) : ""));
  const RunSummary& s = *r.summary;
  out += key("Power of one slice", with_error(s.power) + "\u00a0W",
             s.slices == 1 ? "the slice is the mill"
                           : fmt::format("the mill’s {:.3g} slices: {} W", s.slices,
                                         number(s.mill_power.value, s.mill_power.se)));
  out += key("Toe in the film", degrees_of(film.toe_deg), "simulation " + degrees_of(truth.toe_deg));
  out += key("Shoulder in the film", degrees_of(film.shoulder_deg), "simulation " + degrees_of(truth.shoulder_deg));
  if (film.frames > 0)
    out += key("Balls seen in a frame", fmt::format("{:.4g}", static_cast<double>(film.tracks.size()) / film.frames),
               fmt::format("of {}", r.setup->balls.size()));
  if (std::isfinite(s.energy_error))
    out += key("Energy balance", fmt::format("{:.2g} %", 100 * std::abs(s.energy_error)),
               "of the drive’s work is not accounted for");
  return out;
}

std::string url_of(const fs::path& file) {
  std::string out;
  for (const char c : file.string()) {
    const auto byte = static_cast<unsigned char>(c);
    out += std::isalnum(byte) || std::strchr("-._~/", c) ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return out;
}

struct Film {
  std::string html, media_source;
};
Film film_of(const RunReport& r, const fs::path& report_path) {
  if (r.film_file.empty()) return {"<p>No film was rendered.</p>", ""};
  constexpr const char* kAttributes = "controls loop muted playsinline";
  std::error_code error;
  if (fs::file_size(r.film_file, error) > kLargestEmbedded && !error) {
    const fs::path folder = report_path.has_parent_path() ? report_path.parent_path() : fs::path(".");
    return {video_html_of(url_of(fs::proximate(r.film_file, folder, error)), kAttributes), "file: 'self'"};
  }
  return {video_html(r.film_file, kAttributes), ""};
}

std::string rows_of(const Deviation& deviation) {
  std::string rows;
  for (const Difference& d : deviation.differences) {
    if (!std::isfinite(d.b.value)) continue;  // torque: a film has none, and the truth's stands above
    // What has no error of its own takes the digits of the difference, so that the two can be compared by eye.
    const auto shown = [&](const Estimate& e) { return e.se > 0 ? with_error(e) : number(e.value, d.se); };
    rows += fmt::format("<tr{}><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                        std::abs(d.z) > 3 ? " class=\"far\"" : "", escaped(words_for(d.name)), escaped(d.unit),
                        shown(d.a), shown(d.b), with_error({d.difference, d.se}), number(d.z, 1));
  }
  return rows;
}

std::string fact(const std::string& term, const std::string& value) {
  return "<dt>" + term + "</dt><dd>" + value + "</dd>";
}

std::string facts_of(const RunReport& r) {
  const RunSetup& s = *r.setup;
  std::string out = fact("Program", "tumble " + escaped(r.version));
  out += fact("Seed of the packing", std::to_string(s.config.run.seed));
  out +=
      fact("Balls", fmt::format("{} in {} sizes, {:.4g} kg in the slice", s.balls.size(), s.config.charge.balls.size(),
                                std::accumulate(s.balls.mass.begin(), s.balls.mass.end(), 0.0)));
  out += fact("Time step", fmt::format("{:.4g} s", s.time_step));
  out += fact("Frames of the simulation",
              fmt::format("{} at {:.4g} per second", r.truth->frames, r.truth->frames_per_second));
  out += fact("Frames of the film",
              fmt::format("{}, true rate {} per second, {} × {} pixels", r.film->frames,
                          number(r.film->frames_per_second), r.film->camera.width_px, r.film->camera.height_px));
  if (r.seconds_simulating > 0)
    out += fact("Time taken", fmt::format("{:.1f} s simulating, {:.1f} s rendering, {:.1f} s analysing",
                                          r.seconds_simulating, r.seconds_rendering, r.seconds_analysing));
  return out;
}

std::string torque_caption(const ChargeMotion& truth) {
  std::string text = "Mean torque of each frame’s interval that the drive gives to one slice.";
  if (std::isfinite(truth.torque.value))
    text += " Coloured: its mean, " + with_error(truth.torque) + " N\u00a0m, and one standard error to each side.";
  return text;
}

// Seven digits are more than a plot can show.
Json plotted(double v) { return json_number(v, 7); }

template <typename Rows, typename Get>
Json column(const Rows& rows, Get get) {
  Json out = Json::array();
  for (const auto& row : rows) out.push_back(plotted(get(row)));
  return out;
}

// Directions beside their mean rather than in [0, 360), so that a line does not jump across.
Json near_mean(const ChargeMotion& m, const Estimate& mean, double ProfileRow::*of) {
  return column(m.profile, [&](const ProfileRow& row) {
    return std::isfinite(mean.value) ? mean.value + wrap_180(row.*of - mean.value) : row.*of;
  });
}

Json per_frame(const ChargeMotion& m) {
  return {{"time", column(m.profile, [](const ProfileRow& row) { return row.time; })},
          {"toe", near_mean(m, m.toe_deg, &ProfileRow::toe_deg)},
          {"shoulder", near_mean(m, m.shoulder_deg, &ProfileRow::shoulder_deg)}};
}

// Time from one lifter to the next; a twentieth of a turn without lifters. Of a mill at rest: 1 s.
double lifter_passage(const RunSetup& setup) {
  const int lifters = std::max(setup.config.mill.lifters.count, 0);
  return setup.mill_speed > 0 ? 2 * kPi / (setup.mill_speed * (lifters > 0 ? lifters : 20)) : 1.0;
}

// Opposite to the middle of the charge, on a round number: where a plot over all directions is best cut open.
int emptiest_direction(const std::array<double, 360>& occupancy) {
  double c = 0, s = 0;
  for (std::size_t i = 0; i < occupancy.size(); ++i) {
    if (!std::isfinite(occupancy[i])) continue;
    c += occupancy[i] * std::cos(radians(static_cast<double>(i)));
    s += occupancy[i] * std::sin(radians(static_cast<double>(i)));
  }
  return static_cast<int>(wrap_360(30 * std::round((degrees(std::atan2(s, c)) + 180) / 30)));
}

Json data_of(const RunReport& r, int cut, const Json& plots) {
  const ChargeMotion &truth = *r.truth, &film = *r.film;
  const auto same = [](double v) { return v; };
  const double film_seconds = film.profile.empty() ? 0.0 : film.profile.back().time + 1 / film.frames_per_second;
  return {
      {"occupancy",
       {{"start", cut}, {"truth", column(truth.ring_occupancy, same)}, {"film", column(film.ring_occupancy, same)}}},
      {"toe", {plotted(truth.toe_deg.value), plotted(film.toe_deg.value)}},
      {"shoulder", {plotted(truth.shoulder_deg.value), plotted(film.shoulder_deg.value)}},
      {"truth", per_frame(truth)},
      {"film", per_frame(film)},
      {"film_seconds", plotted(film_seconds)},
      {"torque",
       {{"time", column(truth.torque_series, [](const TorqueRow& row) { return row.time; })},
        {"torque", column(truth.torque_series, [](const TorqueRow& row) { return row.torque; })},
        {"passage", plotted(lifter_passage(*r.setup))},
        {"mean", {plotted(truth.torque.value), plotted(std::isfinite(truth.torque.se) ? truth.torque.se : 0.0)}}}},
      {"plots", plots}};
}

std::string picture_caption(const ChargeMotion& m) {
  std::string text = "Shade: mean share of the area that balls cover. Arrows: mean velocity.";
  if (std::isfinite(m.centre_of_circulation_x.value)) text += " Cross: centre of circulation.";
  return text;
}

}  // namespace

void write_run_report(const fs::path& path, const RunReport& r) {
  const Config& config = r.setup->config;
  const MillShape shape = make_mill_shape(config);
  const Film film = film_of(r, path);
  const int cut = emptiest_direction(r.truth->ring_occupancy);
  std::string sections;
  Json plots = Json::array();
  for (const PageSection& section : run_sections(r, cut)) {
    const std::string id = fmt::format("run-{}", plots.size());
    sections += section_html(section, id);
    for (Json& plot : plots_json(section.plots, id)) plots.push_back(std::move(plot));
  }
  const std::string title = title_of(config);
  write_text(
      path,
      filled(run_html,
             {{"top", std::string(top_html)},
              {"head", head_html(title, "; media-src data: blob: " + film.media_source)},
              {"title", escaped(title)},
              {"lead", escaped(lead_of(r))},
              {"caveats", caveats_of(r)},
              {"keys", keys_of(r)},
              {"film", film.html},
              {"film_caption",
               "The simulation as it was rendered and then analysed; the upright line in the plots "
               "over time stands where the film is."},
              {"truth_picture", mill_picture(shape, *r.truth, nullptr, "Mean charge in the simulation")},
              {"truth_picture_caption", picture_caption(*r.truth)},
              {"film_picture", mill_picture(shape, *r.film, r.truth, "Mean charge as found in the film")},
              {"film_picture_caption", "Broken lines: the simulation’s toe and shoulder."},
              {"torque_caption", escaped(torque_caption(*r.truth))},
              {"sections", sections},
              {"table_intro", "The analyser saw the film, the mill’s drawing and the ball sizes, and nothing else."},
              {"rows", rows_of(*r.deviation)},
              {"facts", facts_of(r)},
              {"config", escaped(r.config_text)},
              {"footer", footer_html(r.version)},
              {"data", script_json(data_of(r, cut, plots))},
              {"uplot_js", std::string(uplot_js)},
              {"plots_js", std::string(plots_js)},
              {"script", std::string(run_js)}}));
}

}  // namespace tumble::io
