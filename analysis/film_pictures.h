#pragma once
#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/charge_motion.h"
#include "core/image.h"
#include "core/progress.h"

namespace tumble::analysis {

// What of a film's pictures is to be seen: a square about the mill, or the whole picture where the mill's place is not
// known.
struct PictureView {
  CameraView camera;
  bool clockwise = false;  // the film's mill turns so: places of the mill are reported mirrored
  bool mirror = false;     // hand clockwise films out mirrored, so that all turn alike
  double margin = 1.1;     // half the square's edge in mill radii
  int edge_px = 480;       // of the pictures handed out
  // The mill as from far away along its axis, upright: perspective, distortion and roll are taken out, so that the
  // plane `depth` behind the glass is true to scale. Otherwise the picture is as the film has it.
  bool straightened = false;
  double depth = 0;  // [mill radii], >= 0
};

// Hands out the pictures of `frames` (numbers of the film's or the stills' frames, never falling; one may come several
// times), as far as they go; transparent where the square reaches beyond them. `path`: as measured, a film, a folder of
// stills or one. Throws InputError where it cannot be read.
void show_film(const std::string& path, const PictureView& view, std::span<const int> frames,
               const std::function<void(const Image&)>& use, const Progress& progress = {});

// Where a place of the mill (as reported: upright, counter-clockwise; `behind` the glass) lies in the pictures that are
// handed out, in pixels. All lengths in mill radii.
Eigen::Vector2d place_in_picture(const PictureView& view, double x, double y, double behind);

// The outline of a ball that touches the glass, as so many corners.
std::vector<Eigen::Vector2d> ball_in_picture(const PictureView& view, double x, double y, double radius, int corners);

}  // namespace tumble::analysis
