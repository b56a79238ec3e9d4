#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/mill_shape.h"
#include "core/sharp_edge.h"
#include "diagnose/check_parts.h"
#include "diagnose/seen_charge.h"

// Lengths by the balls themselves: they touch at the sum of their radii and lie against the shell. Neither knows of the
// clock or of gravity. What a film's balls touch at has gone into its scale already (analysis/ball_plane.h).
namespace tumble::diagnose {
namespace {

constexpr std::size_t kSample = 200;                         // frames from which lengths are told
constexpr int kSectors = 24;                                 // of the shell
constexpr double kLeast = 0.94, kMost = 1.06;                // of the true lengths: where a crowd is looked for
constexpr double kTouchingError = 8e-4, kShellError = 2e-4;  // what touching bodies overlap, and nothing is round
constexpr double kAgainst = 0.01;                            // of the shell's radius: a ball as near lies against it
constexpr double kMostOfThem = 0.75;  // where balls leave the shell or land on it, their outermost are not against it

std::vector<const SeenFrame*> sample_of(const Measurement& m) {
  std::vector<const SeenFrame*> frames;
  const std::size_t n = m.frames.size(), taken = std::min(n, kSample);
  for (std::size_t i = 0; i < taken; ++i) frames.push_back(&m.frames[i * n / taken]);
  return frames;
}

double true_radius(const Config& config, double seen) {
  const int k = class_of(config, seen);
  return k < 0 ? kNotGiven : config.charge.balls[static_cast<std::size_t>(k)].radius;
}

// Seen over true distances of balls that are near each other.
std::vector<double> gaps_of(const Measurement& m) {
  std::vector<double> gaps;
  std::vector<Sighting> balls;
  for (const SeenFrame* frame : sample_of(m)) {
    balls = frame->balls;
    for (Sighting& s : balls) s.radius = true_radius(m.config, s.radius);
    std::erase_if(balls, [](const Sighting& s) { return std::isnan(s.radius); });
    std::sort(balls.begin(), balls.end(), [](const Sighting& a, const Sighting& b) { return a.x < b.x; });
    double widest = 0;
    for (const Sighting& s : balls) widest = std::max(widest, s.radius);
    for (std::size_t i = 0; i < balls.size(); ++i)
      for (std::size_t j = i + 1; j < balls.size() && balls[j].x - balls[i].x < 2 * kMost * widest; ++j)
        gaps.push_back(std::hypot(balls[j].x - balls[i].x, balls[j].y - balls[i].y) /
                       (balls[i].radius + balls[j].radius));
  }
  return gaps;
}

bool is_crowded(const std::vector<double>& places, double edge) {
  double near = 0, against = 0;
  for (const double at : places) {
    near += at > kLeast;
    against += std::abs(at - edge) < kAgainst;
  }
  return against > kMostOfThem * near;
}

}  // namespace

SeenShell seen_shell(const Measurement& m) {
  const double radius = make_mill_shape(m.config).radius;
  double sum_of_radii = 0, balls = 0;
  std::vector<std::vector<double>> sectors(kSectors);
  for (const SeenFrame* frame : sample_of(m))
    for (const Sighting& s : frame->balls) {
      const double r = true_radius(m.config, s.radius);
      if (std::isnan(r)) continue;
      sum_of_radii += r;
      balls += 1;
      const double turn = wrap_360(degrees(std::atan2(s.y, s.x))) / 360;
      sectors[std::min<std::size_t>(kSectors - 1, static_cast<std::size_t>(turn * kSectors))].push_back(
          std::hypot(s.x, s.y) / (radius - r));
    }
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::vector<std::pair<Eigen::Vector3d, Estimate>> edges;
  for (int k = 0; k < kSectors; ++k) {
    const Estimate edge = sharp_edge(sectors[static_cast<std::size_t>(k)], kLeast, kMost, -1);
    if (std::isnan(edge.value) || !is_crowded(sectors[static_cast<std::size_t>(k)], edge.value)) continue;
    const double a = 2 * kPi * (k + 0.5) / kSectors;
    edges.push_back({{1, std::cos(a), std::sin(a)}, edge});
  }
  constexpr std::size_t kFewest = 6;  // sectors: a third of the way round tells a circle
  if (edges.size() < kFewest) return {};
  for (const auto& [direction, edge] : edges) {
    const double weight = 1 / (edge.se * edge.se + kShellError * kShellError);
    information += weight * direction * direction.transpose();
    right += weight * edge.value * direction;
  }
  const Eigen::Matrix3d covariance = information.inverse();
  const Eigen::Vector3d circle = covariance * right;
  double chi2 = 0;
  for (const auto& [direction, edge] : edges)
    chi2 += std::pow(edge.value - direction.dot(circle), 2) / (edge.se * edge.se + kShellError * kShellError);
  const double wider = std::sqrt(std::max(1.0, chi2 / double(edges.size() - 3)));  // Birge 1932
  const auto part = [&](int i, double length) {
    return Estimate{length * circle[i], length * wider * std::sqrt(covariance(i, i))};
  };
  const double path = radius - sum_of_radii / balls;  // of balls that lie against it
  return {part(1, path), part(2, path), part(0, radius)};
}

void check_lengths(const Measurement& m, std::vector<ExactCheck>& checks) {
  if (m.is_film) {
    const Estimate& shell = m.motion.shell_by_balls;
    if (!std::isnan(shell.value))
      checks.push_back(make_check(m, "shell_by_balls", shell.value, 1, shell.se, "", {{"camera_scale", -1}},
                                  {"by the balls' sizes the film's shell is, over mill.diameter,",
                                   "the two fit together", "mill.diameter or charge.balls is not that of this film"}));
  } else if (const Estimate touching = sharp_edge(gaps_of(m), kLeast, kMost, +1); !std::isnan(touching.value)) {
    checks.push_back(make_check(m, "touching_balls", touching.value, 1, std::hypot(touching.se, kTouchingError), "",
                                {{"camera_scale", 1}},
                                {"balls touch at, over the sum of their radii,", "lengths are to scale",
                                 "lengths are out of scale, or charge.balls has other balls"}));
  }
  const double radius = make_mill_shape(m.config).radius;
  const SeenShell shell = seen_shell(m);
  if (std::isnan(shell.radius.value)) return;
  checks.push_back(make_check(m, "shell_radius", shell.radius.value, radius,
                              std::hypot(shell.radius.se, kShellError * radius), "m", {{"camera_scale", 1 / radius}},
                              {"balls lie against a shell of radius", "lengths are to scale",
                               "lengths are out of scale, or mill.diameter is another mill's"}));
  const CameraView& camera = m.motion.camera;  // a film's places are about the axis that its camera was found to have
  const double axis_error = std::hypot(camera.centre_u_px_se, camera.centre_v_px_se) * camera.metres_per_pixel;
  const double by_camera = m.is_film && !std::isnan(axis_error) ? axis_error : 0.0;
  for (const auto& [name, axis, centre] :
       {std::tuple{"mill_centre_x", "right", shell.centre_x}, std::tuple{"mill_centre_y", "up", shell.centre_y}})
    checks.push_back(make_check(m, name, centre.value, 0, std::hypot(centre.se, kShellError * radius, by_camera), "m",
                                {},
                                {fmt::format("the shell that balls lie against has its middle, to the {},", axis),
                                 "positions are about the mill's axis", "positions are not about the mill's axis"}));
}

}  // namespace tumble::diagnose
