#include "core/mill_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/effects.h"

namespace tumble {
namespace {

MillShape circle_of(const Mill& mill) {
  MillShape shape;
  shape.radius = shape.tip_radius = mill.diameter / 2;
  const Lifters& lifters = mill.lifters;
  if (lifters.profile == LifterProfile::kNone || lifters.count < 1) return shape;
  shape.lifter_count = lifters.count;
  if (!std::isnan(lifters.height)) shape.tip_radius -= lifters.height;
  return shape;
}

}  // namespace

double MillShape::pitch() const { return lifter_count > 0 ? 2 * kPi / lifter_count : 2 * kPi; }

MillShape make_mill_shape(const Mill& mill) {
  MillShape shape = circle_of(mill);
  if (shape.lifter_count == 0) return shape;
  LifterSection section = make_section(mill, {});
  if (section.chain.empty()) return shape;
  shape.tip_radius = section.tip_radius();
  shape.sections.push_back(std::move(section));
  shape.section_of.assign(static_cast<std::size_t>(shape.lifter_count), 0);
  return shape;
}

MillShape make_mill_shape(const Config& config) {
  MillShape shape = make_mill_shape(config.mill);
  if (shape.sections.empty()) return shape;

  if (has_effect(config, "lifter_wear")) {
    const std::vector<int> worn = effect_list(config, "lifter_wear", "lifters");
    LifterSection section = make_section(config.mill, {effect_value(config, "lifter_wear", "height_loss"),
                                                       effect_value(config, "lifter_wear", "rounding")});
    if (worn.empty()) {
      shape.sections.front() = std::move(section);
    } else {
      shape.sections.push_back(std::move(section));
      for (const int k : worn) shape.section_of[static_cast<std::size_t>(k)] = 1;
    }
  }
  if (has_effect(config, "missing_lifters"))
    for (const int k : effect_list(config, "missing_lifters", "lifters"))
      shape.section_of[static_cast<std::size_t>(k)] = -1;

  shape.tip_radius = shape.radius;
  for (int s = 0; s < static_cast<int>(shape.sections.size()); ++s)
    if (std::find(shape.section_of.begin(), shape.section_of.end(), s) != shape.section_of.end())
      shape.tip_radius = std::min(shape.tip_radius, shape.sections[static_cast<std::size_t>(s)].tip_radius());
  return shape;
}

std::vector<OutlinePoint> labelled_outline(const MillShape& shape, double chord) {
  std::vector<OutlinePoint> points;
  const auto on_shell = [&](double from, double to) {  // open at the end
    const int n = static_cast<int>(std::ceil((to - from) * shape.radius / chord - 1e-6));
    for (int i = 0; i < n; ++i) {
      const double a = from + (to - from) * i / n;
      points.push_back({shape.radius * Eigen::Vector2d(std::cos(a), std::sin(a)), -1, Face::kPlate});
    }
  };

  struct Part {  // a section's visible chain, open at the end
    std::vector<OutlinePoint> points;
    double begin = 0, end = 0;  // where it meets the shell [rad]
  };
  std::vector<Part> parts;
  for (const LifterSection& section : shape.sections) {
    Part part;
    const auto chain = clipped(section, shape.radius);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const Eigen::Vector2d t = chain[i + 1] - chain[i];
      part.points.push_back(
          {chain[i], 0, face_of(section, shape.radius, (chain[i] + chain[i + 1]) / 2, {-t.y(), t.x()})});
    }
    part.begin = std::atan2(chain.front().y(), chain.front().x());
    part.end = std::atan2(chain.back().y(), chain.back().x());
    if (section.smooth && part.begin > 0) part.begin -= 2 * kPi;  // a single wave begins opposite its crest
    parts.push_back(std::move(part));
  }

  std::vector<int> there;
  for (int k = 0; k < static_cast<int>(shape.section_of.size()); ++k)
    if (shape.section_of[static_cast<std::size_t>(k)] >= 0) there.push_back(k);
  if (there.empty()) {
    on_shell(0, 2 * kPi);
    return points;
  }
  const auto part_of = [&](int k) -> const Part& {
    return parts[static_cast<std::size_t>(shape.section_of[static_cast<std::size_t>(k)])];
  };
  for (std::size_t i = 0; i < there.size(); ++i) {
    const int k = there[i], next = there[(i + 1) % there.size()];
    const double angle = k * shape.pitch();
    const double on = (i + 1 < there.size() ? 0 : 2 * kPi) + next * shape.pitch();
    for (OutlinePoint p : part_of(k).points) {
      p.at = Eigen::Rotation2Dd(angle) * p.at;
      p.lifter = k;
      points.push_back(p);
    }
    on_shell(angle + part_of(k).end, on + part_of(next).begin);
  }
  return points;
}

std::vector<Eigen::Vector2d> outline(const MillShape& shape, double chord) {
  std::vector<Eigen::Vector2d> points;
  for (const OutlinePoint& p : labelled_outline(shape, chord)) points.push_back(p.at);
  return points;
}

}  // namespace tumble
