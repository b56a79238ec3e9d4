#pragma once
#include <functional>
#include <span>
#include <string>

#include "core/charge_motion.h"
#include "core/image.h"
#include "core/progress.h"

namespace tumble::analysis {

// What of a film's pictures is to be seen: a square about the mill, mirrored where the mill turns clockwise, so that
// all films turn alike; the whole picture where the mill's place is not known.
struct PictureView {
  CameraView camera;
  bool mirror = false;
  double margin = 1.1;  // half the square's edge in mill radii
  int edge_px = 480;    // of the pictures handed out
};

// Hands out the pictures of `frames` (numbers of the file's frames, never falling; one may come several times), as far
// as the film goes. Throws InputError where it cannot be read.
void show_film(const std::string& path, const PictureView& view, std::span<const int> frames,
               const std::function<void(const Image&)>& use, const Progress& progress = {});

}  // namespace tumble::analysis
