#include "core/mill_shape.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace tumble {
namespace {

// Across the lifter (tangential, counter-clockwise) where the faces start at the foot and end at the tip.
struct Section {
  double foot_trailing, foot_leading, tip_trailing, tip_leading;
};

Section section_of(const Lifters& lifters) {
  const double half = lifters.width / 2;
  const auto run_in = [&](double angle_deg) { return lifters.height * std::tan(radians(angle_deg)); };
  switch (lifters.profile) {
    case LifterProfile::kTriangle: {
      // One apex. Slanted in the direction of rotation unless an angle says otherwise (1992 paper, p. 602): the leading
      // face takes the whole width and the trailing face is radial.
      double apex = -half;
      if (!std::isnan(lifters.leading_angle_deg))
        apex = half - run_in(lifters.leading_angle_deg);
      else if (!std::isnan(lifters.trailing_angle_deg))
        apex = -half + run_in(lifters.trailing_angle_deg);
      return {-half, half, apex, apex};
    }
    case LifterProfile::kTrapezoid: {
      const double leading = lifters.leading_angle_deg;
      const double trailing = std::isnan(lifters.trailing_angle_deg) ? leading : lifters.trailing_angle_deg;
      return {-half, half, -half + run_in(trailing), half - run_in(leading)};
    }
    default:
      return {-half, half, -half, half};
  }
}

}  // namespace

double MillShape::pitch() const { return lifter_count > 0 ? 2 * kPi / lifter_count : 2 * kPi; }

MillShape make_mill_shape(const Mill& mill) {
  MillShape shape;
  shape.radius = shape.tip_radius = mill.diameter / 2;
  const Lifters& lifters = mill.lifters;
  if (lifters.profile == LifterProfile::kNone || lifters.count < 1 || std::isnan(lifters.height)) return shape;
  shape.lifter_count = lifters.count;
  shape.tip_radius = shape.radius - lifters.height;
  if (std::isnan(lifters.width)) return shape;

  const Section s = section_of(lifters);
  // The faces start inside the steel, so that no gap opens between a straight foot and the round shell. They are drawn
  // on along their own lines: a slanted face meets the shell where it should.
  const double tip = shape.tip_radius;
  const double foot = shape.radius + lifters.width * lifters.width / (2 * shape.radius);
  const double on = (foot - tip) / lifters.height;
  const auto at_foot = [&](double from, double to) { return to + (from - to) * on; };
  shape.lifter = {{foot, at_foot(s.foot_trailing, s.tip_trailing)},
                  {foot, at_foot(s.foot_leading, s.tip_leading)},
                  {tip, s.tip_leading}};
  if (s.tip_leading > s.tip_trailing) shape.lifter.emplace_back(tip, s.tip_trailing);
  return shape;
}

std::vector<Eigen::Vector2d> outline(const MillShape& shape, double chord) {
  std::vector<Eigen::Vector2d> points;
  const auto arc = [&](double from, double to) {  // open at the end
    const int n = std::max(1, static_cast<int>(std::ceil((to - from) * shape.radius / chord)));
    for (int i = 0; i < n; ++i) {
      const double a = from + (to - from) * i / n;
      points.emplace_back(shape.radius * std::cos(a), shape.radius * std::sin(a));
    }
  };
  if (shape.lifter.empty()) {
    arc(0, 2 * kPi);
    return points;
  }
  // Where a face's line crosses the shell: the angle at which |tip + t (foot - tip)| = R.
  const auto crossing = [&](const Eigen::Vector2d& tip, const Eigen::Vector2d& foot) {
    const Eigen::Vector2d d = foot - tip;
    const double a = d.squaredNorm(), b = tip.dot(d), c = tip.squaredNorm() - shape.radius * shape.radius;
    const Eigen::Vector2d p = tip + d * ((-b + std::sqrt(b * b - a * c)) / a);
    return std::atan2(p.y(), p.x());
  };
  const double trailing = crossing(shape.lifter.back(), shape.lifter[0]);
  const double leading = crossing(shape.lifter[2], shape.lifter[1]);
  for (int k = 0; k < shape.lifter_count; ++k) {
    const double a = k * shape.pitch(), c = std::cos(a), s = std::sin(a);
    const auto turned = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector2d(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    };
    points.emplace_back(shape.radius * std::cos(a + trailing), shape.radius * std::sin(a + trailing));
    for (std::size_t i = shape.lifter.size() - 1; i >= 2; --i) points.push_back(turned(shape.lifter[i]));
    arc(a + leading, a + shape.pitch() + trailing);
  }
  return points;
}

}  // namespace tumble
