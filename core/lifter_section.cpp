#include "core/lifter_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace tumble {
namespace {

using Vec2 = Eigen::Vector2d;
using Chain = std::vector<Vec2>;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Where the line from `inner`, inside the circle, through `outer` leaves it.
Vec2 leaves_circle(const Vec2& inner, const Vec2& outer, double radius) {
  const Vec2 d = outer - inner;
  const double a = d.squaredNorm(), b = inner.dot(d), c = inner.squaredNorm() - radius * radius;
  return inner + d * ((-b + std::sqrt(std::max(0.0, b * b - a * c))) / a);
}

// A foot well inside the steel, on the line of its face.
Vec2 foot_in_steel(const Vec2& inner, const Vec2& outer, double radius) {
  return leaves_circle(inner, outer, radius) + 0.02 * radius * (outer - inner).normalized();
}

// Across the lifter where the faces start at the foot and end at the tip.
struct Faces {
  double foot_trailing, foot_leading, tip_trailing, tip_leading;
};

Faces faces_of(const Lifters& lifters) {
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

// Rectangle, triangle, trapezoid: straight faces, drawn on into the steel along their own lines, so that a slanted face
// meets the shell where it should.
Chain straight(const Lifters& lifters, double radius, double loss) {
  const Faces f = faces_of(lifters);
  const double height = lifters.height * (1 - loss);
  const double tip = radius - height;
  const double foot = radius + lifters.width * lifters.width / (2 * radius);
  const double on = (foot - tip) / height;
  const auto at_foot = [&](double from, double to) { return to + (from - to) * on; };
  Chain chain{{foot, at_foot(f.foot_trailing, f.tip_trailing)}, {tip, f.tip_trailing}};
  if (f.tip_leading > f.tip_trailing) chain.emplace_back(tip, f.tip_leading);
  chain.emplace_back(foot, at_foot(f.foot_leading, f.tip_leading));
  return chain;
}

Chain polygon(const Lifters& lifters, double radius, double loss) {
  Chain chain;
  for (const auto& [height, across] : lifters.points) chain.emplace_back(radius - height * (1 - loss), across);
  if (chain.size() < 3) return {};
  chain.front() = foot_in_steel(chain[1], chain.front(), radius);
  chain.back() = foot_in_steel(chain[chain.size() - 2], chain.back(), radius);
  return chain;
}

// A rectangular bar, tilted about its foot's middle on the shell: > 0 leans back, against the rotation.
Chain swivel(const Lifters& lifters, double radius, double loss) {
  const double tilt = std::isnan(lifters.swivel_angle_deg) ? 0 : radians(lifters.swivel_angle_deg);
  const Vec2 in(-std::cos(tilt), -std::sin(tilt)), ahead(-std::sin(tilt), std::cos(tilt));
  const Vec2 top = Vec2(radius, 0) + lifters.height * (1 - loss) * in;
  const Vec2 trailing = top - lifters.width / 2 * ahead, leading = top + lifters.width / 2 * ahead;
  return {foot_in_steel(trailing, trailing - in, radius), trailing, leading,
          foot_in_steel(leading, leading - in, radius)};
}

// r(theta) = R - h/2 (1 + cos(n theta)) from trough to trough: troughs touch the shell's circle.
Chain wave(const Lifters& lifters, double radius, double loss) {
  const double height = lifters.height * (1 - loss), n = lifters.count;
  // Sagitta of a chord = chord^2 x curvature / 8, with a bound for the curvature at crest and trough.
  const double crest = radius - height;
  const double curvature = n * n * height / (2 * crest * crest) + 1 / crest;
  const double chord = std::sqrt(8 * kSagitta * radius / curvature), length = 2 * kPi * radius / n;
  const int chords = 2 * std::max(4, static_cast<int>(std::ceil(length / chord / 2)));
  Chain chain;
  for (int i = 0; i <= chords; ++i) {
    const double angle = kPi / n * (2.0 * i / chords - 1);
    const double r = radius - height / 2 * (1 + std::cos(n * angle));
    chain.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return chain;
}

// Convex edges become arcs that touch both faces. Where edges share a face that is too short for both, or a face ends
// at the shell, their radii shrink.
Chain rounded(const Chain& chain, double shell_radius, double rounding) {
  const std::size_t n = chain.size();
  std::vector<double> length(n - 1), turn(n, 0.0), tangent(n, 0.0);
  for (std::size_t i = 0; i + 1 < n; ++i) length[i] = (chain[i + 1] - chain[i]).norm();
  length.front() = (leaves_circle(chain[1], chain[0], shell_radius) - chain[1]).norm();
  length.back() = (leaves_circle(chain[n - 2], chain[n - 1], shell_radius) - chain[n - 2]).norm();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vec2 in = (chain[i] - chain[i - 1]).normalized(), out = (chain[i + 1] - chain[i]).normalized();
    turn[i] = -std::atan2(cross(in, out), in.dot(out));  // > 0 where convex: to the right
    if (turn[i] > 1e-6) tangent[i] = rounding * std::tan(std::min(turn[i], 0.99 * kPi) / 2);
  }
  Chain round{chain.front()};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (!(tangent[i] > 0)) {
      round.push_back(chain[i]);
      continue;
    }
    const double fits = std::min({1.0, 0.999 * length[i - 1] / (tangent[i] + tangent[i - 1]),
                                  0.999 * length[i] / (tangent[i] + tangent[i + 1])});
    const double reach = fits * tangent[i], radius = reach / std::tan(turn[i] / 2);
    const Vec2 in = (chain[i] - chain[i - 1]).normalized();
    const Vec2 begin = chain[i] - reach * in, centre = begin + radius * Vec2(in.y(), -in.x());
    const double sagitta = std::min(kSagitta * shell_radius / radius, 0.002);  // a dozen chords a right angle
    const int chords = static_cast<int>(std::ceil(turn[i] / (2 * std::acos(1 - sagitta))));
    for (int k = 0; k <= chords; ++k)
      round.push_back(centre + Eigen::Rotation2Dd(-turn[i] * k / chords) * (begin - centre));
  }
  round.push_back(chain.back());
  return round;
}

// Do the segments ab and cd meet?
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 u = b - a, v = d - c;
  const double area = cross(u, v);
  if (area == 0) return false;  // neighbours in one line are told by their direction
  const double s = cross(c - a, v) / area, t = cross(c - a, u) / area;
  return s >= 0 && s <= 1 && t >= 0 && t <= 1;
}

bool crosses_itself(const Chain& p) {
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    if (i + 2 < p.size()) {
      const Vec2 in = p[i + 1] - p[i], out = p[i + 2] - p[i + 1];
      if (std::abs(cross(in, out)) < 1e-9 * in.norm() * out.norm() && in.dot(out) < 0) return true;  // doubles back
    }
    for (std::size_t j = i + 2; j + 1 < p.size(); ++j)
      if (meet(p[i], p[i + 1], p[j], p[j + 1])) return true;
  }
  return false;
}

bool chains_meet(const Chain& p, const Chain& q) {
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    for (std::size_t j = 0; j + 1 < q.size(); ++j)
      if (meet(p[i], p[i + 1], q[j], q[j + 1])) return true;
  return false;
}

}  // namespace

double LifterSection::tip_radius() const {
  double nearest = INFINITY;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const Vec2 &a = chain[i], t = (chain[i + 1] - a).normalized();
    const double along = -a.dot(t);
    const bool beside = along >= 0 && along <= (chain[i + 1] - a).norm();
    nearest = std::min({nearest, a.norm(), chain[i + 1].norm(), beside ? std::abs(cross(a, t)) : INFINITY});
  }
  return nearest;
}

LifterSection make_section(const Mill& mill, const Wear& wear) {
  const Lifters& lifters = mill.lifters;
  const double radius = mill.diameter / 2;
  const bool sized = !std::isnan(radius) && !std::isnan(lifters.height);
  LifterSection section;
  switch (lifters.profile) {
    case LifterProfile::kNone:
      return section;
    case LifterProfile::kWave:
      section.smooth = true;
      if (sized) section.chain = wave(lifters, radius, wear.height_loss);
      return section;  // it has no edges
    case LifterProfile::kPolygon:
      if (!std::isnan(radius)) section.chain = polygon(lifters, radius, wear.height_loss);
      break;
    case LifterProfile::kSwivel:
      if (sized && !std::isnan(lifters.width)) section.chain = swivel(lifters, radius, wear.height_loss);
      break;
    case LifterProfile::kTrapezoid:
      if (std::isnan(lifters.leading_angle_deg)) return section;
      [[fallthrough]];
    default:
      if (sized && !std::isnan(lifters.width)) section.chain = straight(lifters, radius, wear.height_loss);
  }
  if (wear.rounding > 0 && !section.chain.empty()) section.chain = rounded(section.chain, radius, wear.rounding);
  return section;
}

std::vector<Vec2> clipped(const LifterSection& section, double radius) {
  Chain chain = section.chain;
  const std::size_t n = chain.size();
  if (chain[0].norm() > radius) chain[0] = leaves_circle(chain[1], chain[0], radius);
  if (chain[n - 1].norm() > radius) chain[n - 1] = leaves_circle(chain[n - 2], chain[n - 1], radius);
  return chain;
}

std::vector<Vec2> thinned(const std::vector<Vec2>& line, double tolerance) {
  if (line.size() < 3) return line;
  const Vec2 d = line.back() - line.front();
  std::size_t far = 0;
  double farthest = tolerance;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Vec2 to = line[i] - line.front();
    const double t = d.squaredNorm() > 0 ? std::clamp(to.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0;
    if ((to - t * d).norm() <= farthest) continue;
    farthest = (to - t * d).norm();
    far = i;
  }
  if (far == 0) return {line.front(), line.back()};
  const auto middle = line.begin() + static_cast<std::ptrdiff_t>(far);
  std::vector<Vec2> kept = thinned({line.begin(), middle + 1}, tolerance);
  const std::vector<Vec2> rest = thinned({middle, line.end()}, tolerance);
  kept.insert(kept.end(), rest.begin() + 1, rest.end());
  return kept;
}

Face face_of(const LifterSection& section, double shell_radius, const Vec2& place, const Vec2& normal) {
  const Vec2 out = place.normalized();
  if (-normal.dot(out) > std::cos(radians(15)) * normal.norm())
    return shell_radius - place.norm() > (shell_radius - section.tip_radius()) / 2 ? Face::kTop : Face::kPlate;
  return cross(out, normal) >= 0 ? Face::kLeading : Face::kTrailing;
}

std::string flaw_of(const LifterSection& section, double shell_radius, double pitch) {
  for (std::size_t i = 1; i + 1 < section.chain.size(); ++i) {
    if (!(section.chain[i].norm() < shell_radius)) return "dips into the round shell between its feet";
    if (!section.smooth && !(section.chain[i].x() > 1e-6 * shell_radius)) return "reaches the mill's axis";
  }
  const Chain visible = clipped(section, shell_radius);
  if (crosses_itself(visible)) return "crosses itself";
  // Sum over the chain and back along the shell; steel on the right is a negative area.
  const double foot = std::atan2(cross(visible.back(), visible.front()), visible.back().dot(visible.front()));
  double area = shell_radius * shell_radius * foot;
  for (std::size_t i = 0; i + 1 < visible.size(); ++i) area += cross(visible[i], visible[i + 1]);
  if (!section.smooth && area >= 0) return "runs from the leading to the trailing foot";
  if (section.smooth || pitch > 6.28) return "";
  // Neighbours further off cannot be reached but over the nearest.
  const Eigen::Rotation2Dd on(pitch);
  Chain next;
  for (const Vec2& p : visible) next.push_back(on * p);
  const double behind = std::atan2(visible.front().y(), visible.front().x());
  const double ahead = std::atan2(visible.back().y(), visible.back().x());
  if (ahead - behind > pitch || chains_meet(visible, next)) return "overlaps its neighbour";
  return "";
}

}  // namespace tumble
