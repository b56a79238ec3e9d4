// Pages of made-up diagnoses, one of each kind that the report must show well: nothing in them was measured. For
// scripts/check_diagnosis_page.sh and for eyes. Writes FOLDER/KIND.html.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/random.h"
#include "io/config_file.h"
#include "io/diagnosis_file.h"
#include "io/diagnosis_words.h"
#include "io/output.h"

namespace tumble {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kCells = 12;

constexpr const char* kMill = R"(# The one-layer mill in the hall.
[mill]
diameter = 0.55               # inside the shell, m
length = 0.0235               # m: one layer of balls, one slice
speed = 0.7                   # fraction of critical

[mill.lifters]
count = 12
profile = "rectangle"
height = 0.022                # m
width = 0.022                 # m

[charge]
count = 169                   # counted twice
balls = [ { radius = 0.011, density = 7800, share = 1.0 } ]   # m, kg/m3

[contact]
friction = 0.2
restitution = 0.8

[contact.wall]
restitution = 0.4
)";

double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * kPi * random.uniform());
}

// A bed between 215 and 35 degrees, as thick as a third of the radius, smeared.
double bed(double x, double y) {
  const double deg = std::atan2(y, x) * 180 / kPi, off = std::remainder(deg - 305, 360) / 62;
  return 0.8 * std::exp(-std::pow(off, 6)) / (1 + std::exp((0.52 - std::hypot(x, y)) / 0.07));
}

struct Story {
  Diagnosis d;
  Random random{7};

  explicit Story(Finding finding) {
    d.mill = "mill.toml";
    d.measured = "experiments.toml";
    d.finding = finding;
    d.mill_toml = kMill;
    d.simulations = 212;
    d.seconds = 412;
    d.keys = {{"contact.friction", 0.2, 0.03, {0.213, 0.008}},
              {"contact.restitution", 0.8, 0.04, {0.786, 0.031}},
              {"contact.wall.restitution", 0.4, 0.07, {0.432, 0.052}},
              {"contact.normal_stiffness", 4e5, 1.2e5, {3.71e5, 9.8e4}}};
  }

  void experiment(const std::string& name, double speed, double filling, bool hold_out, const std::string& data) {
    const Config c = io::parse_config(kMill, "mill.toml");
    d.experiments.push_back({name, data, hold_out, speed, filling, make_mill_shape(c)});
  }

  void gap(double before, double after, double rival, double torque, double torque_off) {
    const DiagnosedExperiment& e = d.experiments[d.gaps.size()];
    const auto noisy = [&](double v) { return v * (1 + 0.06 * normal(random)); };
    d.gaps.push_back({e.name,
                      e.hold_out,
                      noisy(before),
                      noisy(after),
                      noisy(rival),
                      {torque, 0.06},
                      {torque + torque_off, 0.05},
                      {torque + 0.04 * normal(random), 0.05}});
  }

  // z of a map: chance, and before the repair a pattern of this depth.
  void map(const DiagnosedExperiment& e, const char* observable, const char* unit, double depth, double left,
           const std::function<double(double, double)>& pattern) {
    GapMap m{
        .experiment = e.name, .observable = observable, .unit = unit, .n = kCells, .cell = 2.0 / kCells, .limit = 3.9};
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) {
        const double x = (i + 0.5) * m.cell - 1, y = (j + 0.5) * m.cell - 1;
        const bool inside = std::hypot(x, y) < 1;
        const double at = bed(x, y), se = 0.01 + 0.02 * at, shape = pattern(x, y) * std::sqrt(at);
        const auto put = [&](std::vector<double>& into, double v) { into.push_back(inside ? v : kNotGiven); };
        const double chance = normal(random) * 0.9;
        put(m.measured, at);
        put(m.z_before, chance + depth * shape);
        put(m.z_after, chance + left * shape + 0.4 * normal(random));
        put(m.before, at - se * m.z_before.back());
        put(m.after, at - se * m.z_after.back());
      }
    d.maps.push_back(std::move(m));
  }

  void pockets(const DiagnosedExperiment& e, int odd, double depth, double left) {
    GapMap m{.experiment = e.name, .observable = "pockets", .unit = "pocket areas", .n = 0, .limit = 3.1};
    for (int k = 0; k < 12; ++k) {
      const double chance = normal(random), of = k == odd ? 1 : k == (odd + 1) % 12 ? -0.4 : 0;
      m.z_before.push_back(chance + depth * of);
      m.z_after.push_back(chance + left * of);
      m.measured.push_back(0.62 + 0.02 * chance);
      m.before.push_back(0.62 - 0.02 * depth * of);
      m.after.push_back(0.62);
    }
    d.maps.push_back(std::move(m));
  }

  void films(double depth, double left, int odd = 4, double pocket_depth = 0, double pocket_left = 0) {
    const auto toe = [](double x, double y) {
      return std::exp(-(std::pow(x + 0.55, 2) + std::pow(y + 0.6, 2)) / 0.12);
    };
    const auto shoulder = [](double x, double y) {
      return std::exp(-(std::pow(x - 0.85, 2) + std::pow(y - 0.25, 2)) / 0.1);
    };
    for (const DiagnosedExperiment& e : d.experiments) {
      map(e, "occupancy", "", depth, left, [&](double x, double y) { return shoulder(x, y) - toe(x, y); });
      map(e, "momentum_x", "m/s", 0.6 * depth, left,
          [&](double x, double y) { return toe(x, y) - 0.4 * shoulder(x, y); });
      map(e, "momentum_y", "m/s", 0.8 * depth, left, shoulder);
      map(e, "agitation", "m2/s2", 0.5 * depth, left, toe);
      map(e, "spin", "rad/s", -1.3 * depth, left, [](double x, double y) { return 1.2 * std::hypot(x, y) - 0.3; });
      pockets(e, odd, pocket_depth, pocket_left);
    }
    for (const GapMap& m : d.maps)
      for (std::size_t k = 0; k < m.z_before.size(); ++k) {
        if (!(std::abs(m.z_before[k]) > m.limit)) continue;
        const double x = (static_cast<double>(k % kCells) + 0.5) * m.cell - 1,
                     y = (static_cast<double>(k / kCells) + 0.5) * m.cell - 1;
        const std::string region =
            m.n == 0 ? fmt::format("balls before lifter {}", k)
                     : fmt::format("at {:.0f} deg, {:.2f} R", std::fmod(std::atan2(y, x) * 180 / kPi + 360, 360),
                                   std::hypot(x, y));
        d.where.push_back({m.experiment, m.observable, region, m.z_before[k], m.z_after[k]});
      }
  }

  void torque_curves(double off) {
    for (const DiagnosedExperiment& e : d.experiments) {
      if (e.hold_out) continue;
      TorqueCurve t{.experiment = e.name, .x_name = "mill angle since a lifter passed", .x_unit = "deg"};
      for (double deg = 0; deg < 30; deg += 0.75) {
        const double a = 2 * kPi * deg / 30, mean = 9.5 + 1.1 * std::sin(a) + 0.4 * std::cos(2 * a + e.speed_fraction);
        t.x.push_back(deg);
        t.measured.push_back(mean + 0.06 * normal(random));
        t.before.push_back(mean + off * (1 + 0.5 * std::cos(a)));
        t.after.push_back(mean + 0.03 * std::sin(3 * a));
        t.before_se.push_back(0.09);
        t.after_se.push_back(0.09);
      }
      d.torque.push_back(std::move(t));
    }
  }

  void law(const std::string& name, const std::string& x, const std::string& x_unit, const std::string& y, double model,
           double drop, const std::string& says) {
    LawCurve l{.name = name, .x_name = x, .x_unit = x_unit, .y_name = y, .z = drop * 12, .says = says};
    for (double v = 0.1; v < 2.05; v += 0.15) {
      l.x.push_back(v);
      l.model.push_back(model);
      l.se.push_back(0.012 + 0.01 * v);
      l.y.push_back(model * (1 - drop * (1 - std::exp(-v / 0.5))) + l.se.back() * normal(random));
    }
    d.laws.push_back(std::move(l));
  }

  void checks(double scale, const std::string& says) {
    for (const DiagnosedExperiment& e : d.experiments) {
      const auto add = [&](const char* name, const char* unit, double expected, double se, double off,
                           const std::string& text) {
        const double z = off / se + 0.7 * normal(random);
        d.checks.push_back(
            {e.name, name, unit, expected + z * se, expected, se, z, std::abs(z) > 3 ? text : "as it should be"});
      };
      add("fall in free flight", "m/s2", 9.81, 0.045, 9.81 * scale, says);
      add("direction of free fall", "deg", 270, 0.21, 0, "");
      add("torque less weight × lever", "N m", 0, 0.041, 0, "");
      add("balls in sight", "", 169, 0.4, 0, "");
      add("lifters passing, against the clock", "1/s", 8.31, 0.004, 0, "");
    }
  }

  void rank(const char* name, NameKind kind, double p, const char* parameter, const char* unit, double value, double se,
            double chi, const char* by = "") {
    d.ranking.push_back({name, kind, p, {parameter, unit, {value, se}}, chi, by});
  }
  void rank_the_rest(double chi) {
    const auto known = [&](const std::string& name) {
      for (const RankedName& r : d.ranking)
        if (r.name == name) return true;
      return false;
    };
    for (const auto& [name, parameter, unit, full, by] :
         {std::tuple{"fluid_drag", "viscosity", "Pa s", 0.088, "fall in free flight, at all speeds"},
          {"friction_weakening", "drop", "", 0.4, "spin, at 0.9 of critical"},
          {"wall_friction", "increase", "", 0.5, "pockets, at 0.9 of critical"},
          {"slurry_pool", "density", "kg/m3", 1500., "torque less weight × lever"},
          {"impact_restitution", "drop", "", 0.4, "agitation, at 0.7 of critical"},
          {"end_wall_friction", "coefficient", "", 0.05, "fall in free flight, at all speeds"},
          {"cohesion", "force", "N", 0.6, "occupancy, at 0.5 of critical"},
          {"lifter_wear", "height_loss", "", 0.3, "occupancy, at 0.9 of critical"},
          {"hertz_contact", "share", "", 1., "spin, at 0.5 of critical"},
          {"speed_ripple", "amplitude", "", 0.1, "pockets, at 0.7 of critical"}})
      if (!known(name))
        rank(name, NameKind::kPhysics, 1e-4 * random.uniform(), parameter, unit, full * random.uniform(), 0.1 * full,
             chi * random.uniform(0.9, 1), by);
    for (const auto& [name, full, by] : {std::tuple{"camera_scale", 0.02, "fall in free flight"},
                                         {"frame_clock", 0.02, "fall in free flight"},
                                         {"filling_error", 0.05, "balls in sight"},
                                         {"speed_error", 0.03, "lifters passing, against the clock"},
                                         {"torque_offset", 0.036, "torque less weight × lever"}})
      if (!known(name))
        rank(name, NameKind::kArtefact, 1e-5 * random.uniform(), "relative", "", full * random.uniform(-0.5, 0.5),
             0.1 * full, chi * random.uniform(0.9, 1), by);
    if (!known("none")) rank("none", NameKind::kNone, 2e-7, "", "", kNotGiven, kNotGiven, chi, "spin, at every speed");
    if (!known("unknown")) rank("unknown", NameKind::kUnknown, 0.004, "", "", kNotGiven, kNotGiven, kNotGiven, "");
  }

  void three_speeds(const std::string& data) {
    for (const double speed : {0.5, 0.7, 0.9})
      experiment(fmt::format("J35-{:.0f}", 100 * speed), speed, 0.35, false, data);
    experiment("J35-80", 0.8, 0.35, true, data);
    experiment("J25-70", 0.7, 0.25, true, data);
  }

  const Diagnosis& told() {
    d.model_toml = io::repaired_mill(kMill, "mill.toml", d);
    d.sentence = io::diagnosis_sentence(d);
    return d;
  }
};

void gaps(Story& s, double before, double after, double rival, double off) {
  for (std::size_t i = 0; i < s.d.experiments.size(); ++i)
    s.gap(before * (1 + 0.1 * static_cast<double>(i)), after, rival, 6.5 + 5 * s.d.experiments[i].speed_fraction, off);
}

Diagnosis missing_effect() {
  Story s(Finding::kMissingEffect);
  s.three_speeds("film, torque series");
  s.d.effects = {{"rolling_resistance", NameKind::kPhysics, {{"coefficient", "", {0.0213, 0.0031}}}, 0.981, {}}};
  s.d.runner_up = "friction_weakening";
  s.rank("rolling_resistance", NameKind::kPhysics, 0.981, "coefficient", "", 0.0213, 0.0031, 1.08);
  s.rank("friction_weakening", NameKind::kPhysics, 0.013, "drop", "", 0.31, 0.06, 2.9);
  s.rank_the_rest(5.1);
  gaps(s, 4.6, 1.08, 2.9, 0.35);
  s.films(7, 0.1);
  s.torque_curves(0.4);
  s.checks(0, "");
  s.law("Restitution, ball on ball", "impact speed", "m/s", "restitution", 0.8, 0, "As the model has it.");
  s.law("Change of spin in an impact", "slip", "m/s", "share of sticking", 0.7, 0.35,
        "Spin is lost that no slip takes: rolling resistance.");
  s.d.alike = {{"friction_weakening", "wall_friction"}, {"slurry_pool", "camera_rotation"}};
  s.d.caveats = {"The radii of the balls in film J35-90 were taken from MILL.toml.",
                 "spin is known of 40 % of the balls: those with marks."};
  s.d.worse = {{"J25-70", "agitation", 1.0, 1.3}};
  return s.told();
}

Diagnosis mixture() {
  Story s(Finding::kMissingEffect);
  s.three_speeds("tracks, torque");
  s.d.effects = {{"lifter_wear",
                  NameKind::kPhysics,
                  {{"height_loss", "", {0.41, 0.02}}},
                  0.996,
                  {"effects.lifter_wear.lifters=[4]"}},
                 {"camera_scale", NameKind::kArtefact, {{"relative", "", {0.0187, 0.0011}}}, 0.9996, {}}};
  s.rank("camera_scale", NameKind::kArtefact, 0.9996, "relative", "", 0.0187, 0.0011, 3.1);
  s.rank("lifter_wear", NameKind::kPhysics, 0.996, "height_loss", "", 0.41, 0.02, 4.4);
  s.rank_the_rest(7.1);
  gaps(s, 7.0, 1.1, 3.2, 0.1);
  s.d.runner_up = "missing_lifters";
  s.films(5, 0.1, 4, 11, 0.3);
  s.checks(0.0187, "lengths are 1.9 % too long: scale of the picture");
  return s.told();
}

Diagnosis artefact() {
  Story s(Finding::kMeasurementArtefact);
  s.three_speeds("film");
  s.d.effects = {{"speed_error", NameKind::kArtefact, {{"relative", "", {-0.0287, 0.0012}}}, 0.9996, {}}};
  s.rank("speed_error", NameKind::kArtefact, 0.9996, "relative", "", -0.0287, 0.0012, 1.02);
  s.rank_the_rest(6.3);
  gaps(s, 6.0, 1.02, 5.2, 0.2);
  s.d.runner_up = "frame_clock";
  s.films(6, 0);
  s.checks(0, "");
  return s.told();
}

Diagnosis agreement() {
  Story s(Finding::kAgreement);
  s.three_speeds("film, torque series");
  s.rank("none", NameKind::kNone, 0.962, "", "", kNotGiven, kNotGiven, 1.01);
  s.rank("unknown", NameKind::kUnknown, 0.011, "", "", kNotGiven, kNotGiven, kNotGiven);
  s.rank("friction_weakening", NameKind::kPhysics, 0.009, "drop", "", 0.05, 0.06, 1.0);
  s.rank_the_rest(1.0);
  for (RankedName& r : s.d.ranking) r.ruled_out_by.clear();
  for (std::size_t i = 0; i < s.d.experiments.size(); ++i) s.gap(1.0, kNotGiven, kNotGiven, 9, 0.02);
  for (GapRow& row : s.d.gaps) row.torque_after = {};
  s.films(0, 0);
  for (GapMap& m : s.d.maps) m.after.clear(), m.z_after.clear();
  s.checks(0, "");
  return s.told();
}

Diagnosis unknown() {
  Story s(Finding::kUnknownEffect);
  s.three_speeds("film");
  s.rank("unknown", NameKind::kUnknown, 0.993, "", "", kNotGiven, kNotGiven, kNotGiven);
  s.rank("cohesion", NameKind::kPhysics, 0.006, "force", "N", 0.21, 0.03, 3.4);
  s.rank_the_rest(4.2);
  gaps(s, 4.1, 3.3, 3.4, 0.3);
  s.films(7, 4);
  s.law("Drag in flight", "speed", "m/s", "deceleration, m/s2", 0.02, -2,
        "Balls in flight are pulled to the right, the faster the more.");
  s.d.found_laws = {
      "a force across the velocity that grows with spin, (0.031 ± 0.004) z × ω v; in 97 % of the samples drawn anew."};
  s.d.next = {
      {{{"mill.speed", 0.3}}, "mark ten balls and film at 500 pictures per second, mill slow", {"unknown"}, 6.2, 0.8}};
  return s.told();
}

Diagnosis ambiguous() {
  Story s(Finding::kAmbiguous);
  s.three_speeds("torque, toe and shoulder");
  s.d.effects = {{"friction_weakening", NameKind::kPhysics, {{"drop", "", {0.37, 0.09}}}, 0.44, {}},
                 {"hertz_contact", NameKind::kPhysics, {{"share", "", {0.81, 0.22}}}, 0.31, {}},
                 {"wall_friction", NameKind::kPhysics, {{"increase", "", {-0.28, 0.1}}}, 0.19, {}}};
  s.rank("friction_weakening", NameKind::kPhysics, 0.44, "drop", "", 0.37, 0.09, 1.12);
  s.rank("hertz_contact", NameKind::kPhysics, 0.31, "share", "", 0.81, 0.22, 1.15);
  s.rank("wall_friction", NameKind::kPhysics, 0.19, "increase", "", -0.28, 0.1, 1.17);
  s.rank_the_rest(2.2);
  gaps(s, 2.3, 1.12, 1.15, 0.3);
  s.d.runner_up = "hertz_contact";
  s.d.where = {{"J35-90", "torque", "mill", -3.4, 0.2}, {"J35-70", "angles", "shoulder_deg", 2.9, 0.8}};
  s.d.alike = {{"friction_weakening", "hertz_contact", "wall_friction"}, {"fluid_drag", "torque_offset"}};
  s.d.next = {{{{"mill.speed", 0.5}},
               "film the mill at 0.50 of critical, ten balls marked so that their spin shows",
               {"friction_weakening", "hertz_contact", "wall_friction"},
               5.6,
               1.3},
              {{{"mill.speed", 0.9}}, "film the mill at 0.90 of critical", {"hertz_contact", "wall_friction"}, 3.1, 1},
              {{{"charge.count", 1}}, "let a single ball tumble", {"friction_weakening", "wall_friction"}, 1.4, 0.3}};
  return s.told();
}

Diagnosis power_only() {
  Story s(Finding::kAmbiguous);
  for (const double filling : {0.2, 0.35, 0.25})
    for (const double speed : {0.4, 0.55, 0.7, 0.85, 1.0}) {
      if (filling == 0.2 && speed > 0.8) continue;
      s.experiment(fmt::format("J{:.0f}-{:.0f}", 100 * filling, 100 * speed), speed, filling, filling == 0.25, "power");
    }
  for (const DiagnosedExperiment& e : s.d.experiments)
    s.gap(2.6, 1.2, 1.3, 12 * e.filling * (1 + 0.5 * std::sin(3 * e.speed_fraction)), 0.3 * e.speed_fraction);
  s.d.effects = {{"end_wall_friction", NameKind::kPhysics, {{"coefficient", "", {0.041, 0.012}}}, 0.48, {}},
                 {"torque_offset", NameKind::kArtefact, {{"relative", "", {0.031, 0.008}}}, 0.41, {}}};
  s.rank("end_wall_friction", NameKind::kPhysics, 0.48, "coefficient", "", 0.041, 0.012, 1.2);
  s.rank("torque_offset", NameKind::kArtefact, 0.41, "relative", "", 0.031, 0.008, 1.3);
  s.rank_the_rest(2.6);
  s.d.runner_up = "torque_offset";
  s.d.next = {{{}, "read the torque of the empty mill", {"end_wall_friction", "torque_offset"}, 9.1, 0.1}};
  return s.told();
}

Diagnosis bare() {
  Story s(Finding::kAgreement);
  s.d.keys.clear();
  s.experiment("only one", 0.7, 0.35, false, "power");
  s.d.ranking = {{"none", NameKind::kNone, 0.81, {}, 0.8, ""}};
  s.d.gaps = {{"only one", false, 0.8, kNotGiven, kNotGiven, {9.1, 0.3}, {9.3, 0.1}, {}}};
  return s.told();
}

}  // namespace
}  // namespace tumble

int main(int argc, char** argv) {
  using namespace tumble;
  CLI::App app{"Pages of made-up diagnoses, to be looked at"};
  std::filesystem::path folder, film;
  app.add_option("folder", folder, "Where to write them; it is there")->required();
  app.add_option("--film", film, "A film to show in those that had one");
  CLI11_PARSE(app, argc, argv);
  const std::vector<std::pair<const char*, Diagnosis (*)()>> kinds{
      {"missing_effect", missing_effect}, {"mixture", mixture}, {"artefact", artefact},
      {"agreement", agreement},           {"unknown", unknown}, {"ambiguous", ambiguous},
      {"power_only", power_only},         {"bare", bare}};
  for (const auto& [name, make] : kinds) {
    const Diagnosis d = make();
    std::vector<io::DiagnosisFilm> films;
    if (!film.empty() && !d.maps.empty()) films.push_back({film, "J35-70, two times slower than true time."});
    io::write_diagnosis_page(folder / (std::string(name) + ".html"), d, films);
    io::write_text(folder / (std::string(name) + ".json"), io::diagnosis_json(d));
  }
}
