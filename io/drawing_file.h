#pragma once
#include <filesystem>

#include "core/drawing.h"

// Drawings for papers: circles, paths and text that stay what they are. A pixel of the drawing is a CSS pixel, 1/96 of
// an inch. Written beside `path` and renamed; throw WorkError with the path and the reason. Same drawing, same bytes.
namespace tumble::io {

void write_svg(const std::filesystem::path& path, const Drawing& drawing);
void write_pdf(const std::filesystem::path& path, const Drawing& drawing);

// How a ball is drawn, in radii, so that both look alike: light from the upper left, a dark limb inside of the edge,
// and a painted stripe that ends in a dot on one side.
struct BallLook {
  static constexpr double kLightX = -0.42, kLightY = -0.58;  // the brightest place; y down
  static constexpr double kDarkAt = 1.72;                    // how far from it the shade is deepest
  struct Stop {
    double at, white, alpha;  // share of the way there; white or black, and how much of it
  };
  static constexpr Stop kStops[] = {{0, 1, 0.42}, {0.12, 1, 0.16}, {0.36, 0, 0.0}, {1, 0, 0.6}};
  static constexpr double kStripe = 0.15, kStripeHalf = 0.80, kDotAt = 0.50, kDot = 0.18, kHalo = 0.05;
  static constexpr double kMarkGrey = 0.93, kHaloShade = 0.45, kLimbShade = 0.12;
  static double limb(double radius_px);  // its width [px]
};

}  // namespace tumble::io
