#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/support/mills.h"

// Shells of every profile, new and worn, for the tests of geometry and of leaks.
namespace tumble {

struct NamedMill {
  std::string name;
  Config config;
};

inline Config mill_with_points(std::vector<std::array<double, 2>> points) {
  Config c = paper_mill();
  c.mill.lifters.profile = LifterProfile::kPolygon;
  c.mill.lifters.height = c.mill.lifters.width = kNotGiven;
  c.mill.lifters.points = std::move(points);
  return c;
}

inline Config mill_with_profile(LifterProfile profile) {
  Config c = paper_mill();
  c.mill.lifters.profile = profile;
  return c;
}

inline std::vector<NamedMill> mills_of_every_profile() {
  std::vector<NamedMill> mills;
  mills.push_back({"rectangle", mill_with_profile(LifterProfile::kRectangle)});
  mills.push_back({"triangle", mill_with_profile(LifterProfile::kTriangle)});

  Config c = mill_with_profile(LifterProfile::kTrapezoid);
  c.mill.lifters.width = 0.03;
  c.mill.lifters.leading_angle_deg = 25;
  mills.push_back({"trapezoid", c});

  c = mill_with_profile(LifterProfile::kWave);
  mills.push_back({"wave", c});
  c.mill.lifters.count = 9;
  c.mill.lifters.height = 0.08;
  mills.push_back({"deep wave", c});

  c = mill_with_profile(LifterProfile::kSwivel);
  c.mill.lifters.height = 0.03;
  c.mill.lifters.width = 0.012;
  for (const double tilt : {45.0, -45.0}) {
    c.mill.lifters.swivel_angle_deg = tilt;
    mills.push_back({tilt > 0 ? "swivel back" : "swivel ahead", c});
  }

  mills.push_back(
      {"hook", mill_with_points({{0, -0.01}, {0.03, -0.01}, {0.03, 0.022}, {0.02, 0.022}, {0.02, 0.004}, {0, 0.004}})});
  mills.push_back({"tee", mill_with_points({{0, -0.004},
                                            {0.022, -0.004},
                                            {0.022, -0.02},
                                            {0.03, -0.02},
                                            {0.03, 0.02},
                                            {0.022, 0.02},
                                            {0.022, 0.004},
                                            {0, 0.004}})});
  // A foot that fades out in a hollow of chords that turn by 7 degrees each.
  std::vector<std::array<double, 2>> fillet{{0, -0.028}};
  for (int i = 4; i <= 11; ++i) {
    const double a = kPi / 24 * i;
    fillet.push_back({0.03 - 0.03 * std::cos(a), -0.03 + 0.03 * std::sin(a) - 0.008});
  }
  fillet.push_back({0.04, 0.0});
  fillet.push_back({0.04, 0.012});
  fillet.push_back({0.0, 0.012});
  mills.push_back({"fillet", mill_with_points(fillet)});

  c = mill_with_profile(LifterProfile::kRectangle);
  c.effects["lifter_wear"] = {{"height_loss", {0.2}}, {"rounding", {0.006}}};
  mills.push_back({"worn rectangle", c});
  c.effects["lifter_wear"]["lifters"] = {0, 3, 4, 11};
  c.effects["missing_lifters"] = {{"lifters", {5, 17}}};
  mills.push_back({"some worn, some missing", c});

  c = mills[7].config;
  c.effects["lifter_wear"] = {{"height_loss", {0.1}}, {"rounding", {0.004}}};
  mills.push_back({"worn hook", c});
  c = mill_with_profile(LifterProfile::kWave);
  c.effects["lifter_wear"] = {{"height_loss", {0.5}}, {"lifters", {1, 2, 9}}};
  c.effects["missing_lifters"] = {{"lifters", {6}}};
  mills.push_back({"worn wave", c});
  for (const NamedMill& m : mills) check(m.config);
  return mills;
}

// A valid mill of random profile, sizes and wear.
inline Config random_shell(Random& random) {
  for (;;) {
    Config c = paper_mill();
    Lifters& l = c.mill.lifters;
    l.count = 1 + static_cast<int>(random.below(24));
    l.height = 0.272 * std::pow(random.uniform(0.1, 0.8), 2);
    l.width = random.uniform(0.004, 0.06);
    l.profile = static_cast<LifterProfile>(1 + random.below(6));
    if (l.profile == LifterProfile::kTrapezoid) {
      l.leading_angle_deg = random.uniform(0, 70);
      l.trailing_angle_deg = random.uniform(0, 70);
    }
    if (l.profile == LifterProfile::kTriangle && random.below(2)) l.leading_angle_deg = random.uniform(0, 80);
    if (l.profile == LifterProfile::kSwivel) l.swivel_angle_deg = random.uniform(-60, 60);
    if (l.profile == LifterProfile::kPolygon) {
      l.height = l.width = kNotGiven;
      const int n = 3 + static_cast<int>(random.below(9));
      for (int i = 0; i < n; ++i) {
        const bool foot = i == 0 || i == n - 1;
        l.points.push_back({foot ? 0 : random.uniform(0.003, 0.07),
                            foot ? (i ? 1 : -1) * random.uniform(0.004, 0.03) : random.uniform(-0.04, 0.04)});
      }
    }
    if (random.below(2))
      c.effects["lifter_wear"] = {{"height_loss", {random.uniform(0, 0.6)}}, {"rounding", {random.uniform(0, 0.02)}}};
    if (random.below(3) == 0) c.effects["missing_lifters"] = {{"lifters", {0}}};
    try {
      check(c);
    } catch (const InputError&) {
      continue;  // crossed itself, overlapped, or would not fit
    }
    return c;
  }
}

}  // namespace tumble
