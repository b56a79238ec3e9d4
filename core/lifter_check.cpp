#include "core/lifter_check.h"

#include <cmath>
#include <string>

#include "core/angle.h"
#include "core/config_checker.h"
#include "core/effects.h"
#include "core/error.h"
#include "core/lifter_section.h"

namespace tumble {
namespace {

constexpr std::size_t kMostPoints = 64;
constexpr const char* kProfiles = "\"rectangle\", \"triangle\", \"trapezoid\", \"wave\", \"polygon\", \"swivel\"";

// A key that this profile would not heed is a slip; angles of 0 say nothing.
void check_unheeded(const ConfigChecker& c, const Lifters& l) {
  const bool slanted = l.profile == LifterProfile::kTriangle || l.profile == LifterProfile::kTrapezoid;
  if (!slanted && (l.leading_angle_deg > 0 || l.trailing_angle_deg > 0))
    c.fail(l.leading_angle_deg > 0 ? "leading_angle_deg" : "trailing_angle_deg",
           std::string("has no meaning for a ") + name_of(l.profile) + "; use profile = \"trapezoid\" or \"triangle\"");
  if (l.profile != LifterProfile::kSwivel && !std::isnan(l.swivel_angle_deg) && l.swivel_angle_deg != 0)
    c.fail("swivel_angle_deg",
           std::string("has no meaning for a ") + name_of(l.profile) + "; use profile = \"swivel\"");
  if (l.profile != LifterProfile::kPolygon && !l.points.empty())
    c.fail("points", std::string("have no meaning for a ") + name_of(l.profile) + "; use profile = \"polygon\"");
}

void check_faces(const ConfigChecker& c, const Lifters& l) {
  const auto run_in = [&](double angle_deg) { return l.height * std::tan(radians(angle_deg)); };
  if (l.profile == LifterProfile::kTrapezoid) {
    const double trailing = std::isnan(l.trailing_angle_deg) ? l.leading_angle_deg : l.trailing_angle_deg;
    const double feet = run_in(l.leading_angle_deg) + run_in(trailing);
    if (feet > l.width)
      c.fail("width", "is " + shown(l.width) + " m, the two faces cross below the top; must be at least " +
                          shown(feet) + " m with these angles and height");
  }
  if (l.profile != LifterProfile::kTriangle) return;
  const double leading = run_in(l.leading_angle_deg), trailing = run_in(l.trailing_angle_deg);
  if (std::abs(leading + trailing - l.width) > 0.02 * l.width)
    c.fail("width", "is " + shown(l.width) + " m, but height and the two angles make " + shown(leading + trailing) +
                        " m; give the width and one angle");
  const bool by_leading = leading > l.width * (1 + 1e-9);
  if (by_leading || trailing > l.width * (1 + 1e-9))
    c.fail(by_leading ? "leading_angle_deg" : "trailing_angle_deg",
           "puts the apex beyond the other foot; with this height and width it is at most " +
               shown(degrees(std::atan(l.width / l.height))) + " degrees");
}

void check_points(const ConfigChecker& c, const Mill& m) {
  const auto& points = m.lifters.points;
  if (points.empty()) return;
  if (points.size() < 3 || points.size() > kMostPoints)
    c.fail("points", "are " + std::to_string(points.size()) + ", must be 3 to " + std::to_string(kMostPoints));
  const double radius = m.diameter / 2;
  double highest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [height, across] = points[i];
    const std::string which = "point " + std::to_string(i + 1) + " [" + shown(height) + ", " + shown(across) + "] ";
    const bool foot = i == 0 || i + 1 == points.size();
    if (!std::isfinite(height) || !std::isfinite(across)) c.fail("points", which + "is not a place; give finite m");
    if (foot && std::abs(height) > 1e-9) c.fail("points", which + "is a foot; its height above the shell must be 0");
    if (!foot && height <= 0) c.fail("points", which + "must lie above the shell: between the feet, heights are > 0");
    if (height >= radius || std::abs(across) >= radius)
      c.fail("points", which + "is further off than the mill's radius " + shown(radius) + " m; lengths are in m");
    if (i > 0 && std::hypot(height - points[i - 1][0], across - points[i - 1][1]) < 1e-6 * radius)
      c.fail("points", which + "repeats the point before it");
    highest = std::max(highest, height);
  }
  if (std::abs(m.lifters.height - highest) > 1e-3 * highest)
    c.fail("height", "is " + shown(m.lifters.height) + " m, but the points reach " + shown(highest) +
                         " m; leave it out, the points say it");
}

// Which key to mend where the section as a whole does not work.
void check_section(const ConfigChecker& c, const Mill& m) {
  const Lifters& l = m.lifters;
  const double radius = m.diameter / 2;
  const LifterSection section = make_section(m, {});
  if (section.chain.empty()) return;
  const std::string flaw = flaw_of(section, radius, 2 * kPi / l.count);
  if (flaw.empty()) return;
  const bool by_points = l.profile == LifterProfile::kPolygon;
  const bool crowded = flaw == "overlaps its neighbour";
  if (by_points && !crowded)
    c.fail("points", "make a lifter that " + flaw +
                         "; give them in order from the trailing foot over the top to the leading foot, across > 0 in "
                         "the direction of rotation");
  if (crowded)
    c.fail(by_points ? "points" : "count",
           std::to_string(l.count) + " lifters " +
               (by_points ? std::string() : "of width " + shown(l.width) + " m and height " + shown(l.height) + " m ") +
               "overlap in a mill of diameter " + shown(m.diameter) + " m; use fewer or narrower ones");
  if (l.profile == LifterProfile::kSwivel)
    c.fail("swivel_angle_deg", "is " + shown(l.swivel_angle_deg) + ", the tilted bar " + flaw +
                                   "; tilt it less, or give a higher or narrower bar");
  c.fail("height", "is " + shown(l.height) + " m, a lifter of width " + shown(l.width) + " m " + flaw +
                       "; give a higher or narrower one");
}

void check_worn(const Config& config) {
  if (!has_effect(config, "lifter_wear")) return;
  const LifterSection worn = make_section(config.mill, {effect_value(config, "lifter_wear", "height_loss"),
                                                        effect_value(config, "lifter_wear", "rounding")});
  if (worn.chain.empty() || flaw_of(worn, config.mill.diameter / 2, 2 * kPi / config.mill.lifters.count).empty())
    return;
  throw InputError(place_of(config, "effects.lifter_wear.height_loss"),
                   "leaves nothing of the lifters above the round shell; must be less, or list them in "
                   "effects.missing_lifters");
}

}  // namespace

void check_lifters(const Config& config) {
  const ConfigChecker c{config, "mill.lifters."};
  const Mill& m = config.mill;
  const Lifters& l = m.lifters;
  if (l.profile == LifterProfile::kNone) return;
  c.range("count", l.count, 0, 100000, "");
  c.positive("height", l.height, "m");
  c.positive("width", l.width, "m");
  c.range("leading_angle_deg", l.leading_angle_deg, 0, 85, "degrees from the radius");
  c.range("trailing_angle_deg", l.trailing_angle_deg, 0, 85, "degrees from the radius");
  c.range("swivel_angle_deg", l.swivel_angle_deg, -60, 60, "degrees from the radius");
  check_unheeded(c, l);
  const double radius = m.diameter / 2;
  if (l.height >= radius)
    c.fail("height",
           "is " + shown(l.height) + " m, reaches the mill's axis; must be below the radius " + shown(radius) + " m");
  check_faces(c, l);
  if (l.profile == LifterProfile::kPolygon) check_points(c, m);
  if (l.count < 1) return;
  check_section(c, m);
  check_worn(config);
}

void check_lifters_complete(const Config& config) {
  const ConfigChecker c{config, "mill.lifters."};
  const Lifters& l = config.mill.lifters;
  // A file with sizes and no shape would give a smooth shell that nobody asked for.
  const auto said = [&](const char* key) { return config.origin.contains(std::string("mill.lifters.") + key); };
  if (!said("profile") && l.profile == LifterProfile::kNone &&
      (l.count > 0 || !std::isnan(l.height) || !std::isnan(l.width) || !l.points.empty()))
    c.fail("profile", std::string("is missing; give ") + kProfiles + ", or \"none\"");
  if (l.profile == LifterProfile::kNone) return;
  if (l.count < 1) c.fail("count", "is missing; give the number of lifters, or profile = \"none\"");
  if (l.profile == LifterProfile::kPolygon) {
    if (l.points.empty())
      c.fail("points",
             "are missing; give [ [height above the shell, across], ... ] in m from the trailing foot over "
             "the top to the leading foot");
    return;
  }
  c.given("height", l.height, "the height above the shell in m");
  if (l.profile == LifterProfile::kWave) return;
  c.given("width", l.width, "the width at the foot in m");
  if (l.profile == LifterProfile::kTrapezoid)
    c.given("leading_angle_deg", l.leading_angle_deg, "the leading face's angle from the radius");
  if (l.profile == LifterProfile::kSwivel)
    c.given("swivel_angle_deg", l.swivel_angle_deg, "the bar's tilt in degrees, > 0 back against the rotation");
}

}  // namespace tumble
