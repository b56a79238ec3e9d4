#include "render/film_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"

namespace tumble::render {
namespace {

constexpr int kSectors = 96;
constexpr double kMargin = 2;  // for the jitter of sub-exposures and for chords [px]

using Reach = std::array<double, kSectors>;  // distance from the middle by sector of the picture [px]

// Least or largest distance in each sector, of a circle about the axis.
Reach reach_of(const Pinhole& camera, const Eigen::Vector2d& middle, double radius, double z, bool largest) {
  Reach reach;
  reach.fill(largest ? 0 : 1e9);
  constexpr int kPoints = 16 * kSectors;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * kPi * i / kPoints;
    const Eigen::Vector2d p = camera.image_from_mill({radius * std::cos(angle), radius * std::sin(angle), z}) - middle;
    const double turn = std::atan2(p.y(), p.x()) / (2 * kPi) + 1;
    double& r = reach[static_cast<std::size_t>(turn * kSectors) % kSectors];
    r = largest ? std::max(r, p.norm()) : std::min(r, p.norm());
  }
  return reach;
}

template <class Choose>
Reach joined(const Reach& a, const Reach& b, const Choose& choose) {
  Reach c;
  for (std::size_t k = 0; k < c.size(); ++k) c[k] = choose(a[k], b[k]);
  return c;
}

const auto kLeast = [](double a, double b) { return std::min(a, b); };
const auto kMost = [](double a, double b) { return std::max(a, b); };

// A corner between two sectors keeps clear of both.
template <class Choose>
std::vector<Eigen::Vector2d> corners(const Eigen::Vector2d& middle, const Reach& reach, double margin,
                                     const Choose& choose) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t k = 0; k < reach.size(); ++k) {
    const double r = std::max(0.0, choose(reach[k], reach[(k + reach.size() - 1) % reach.size()]) + margin);
    const double angle = 2 * kPi * static_cast<double>(k) / kSectors;
    points.emplace_back(middle + r * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

void add(std::vector<float>& triangles, const Eigen::Vector2d& p) {
  triangles.push_back(static_cast<float>(p.x()));
  triangles.push_back(static_cast<float>(p.y()));
}

std::vector<float> ring(const std::vector<Eigen::Vector2d>& inner, const std::vector<Eigen::Vector2d>& outer) {
  std::vector<float> triangles;
  for (std::size_t k = 0; k < inner.size(); ++k) {
    const std::size_t n = (k + 1) % inner.size();
    for (const auto* p : {&inner[k], &outer[k], &outer[n], &inner[k], &outer[n], &inner[n]}) add(triangles, *p);
  }
  return triangles;
}

}  // namespace

DrumParts drum_parts(const Pinhole& camera, const FlangeLook& flange, double tip, double depth) {
  const Eigen::Vector2d middle = camera.image_from_mill({0, 0, -0.5 * depth});
  const double bore = flange.there ? flange.inner : 1.04, face = flange.there ? flange.thick : 0;
  // Chords of the outer polygons cut their circles by less than this.
  const double chord = 1 / std::cos(kPi / kSectors) - 1;

  const auto clear = corners(
      middle, joined(reach_of(camera, middle, tip, 0, false), reach_of(camera, middle, tip, -depth, false), kLeast),
      -kMargin, kLeast);
  const Reach bore_out =
      joined(reach_of(camera, middle, bore, 0, true), reach_of(camera, middle, bore, face, true), kMost);
  const double bore_margin = kMargin + chord * *std::max_element(bore_out.begin(), bore_out.end());
  DrumParts parts;
  parts.wall = ring(clear, corners(middle, bore_out, bore_margin, kMost));
  for (std::size_t k = 0; k < clear.size(); ++k)
    for (const auto* p : {&middle, &clear[k], &clear[(k + 1) % clear.size()]}) add(parts.plate, *p);
  if (flange.there) {
    const Reach bore_in =
        joined(reach_of(camera, middle, bore, 0, false), reach_of(camera, middle, bore, face, false), kLeast);
    const Reach rim = reach_of(camera, middle, flange.outer, face, true);
    parts.flange = ring(corners(middle, bore_in, -kMargin, kLeast),
                        corners(middle, rim, kMargin + chord * *std::max_element(rim.begin(), rim.end()), kMost));
  }
  return parts;
}

}  // namespace tumble::render
