#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/drum_reader.h"
#include "analysis/mill_camera.h"
#include "core/config.h"
#include "core/progress.h"
#include "core/statistics.h"

namespace tumble::analysis {

// A circle about the axis that a film shows.
enum class RingKind { kUnknown, kOuterRim, kBore, kShell, kLifterTips };
struct RingFound {
  double radius = 0;    // in the plane z = 0 [m, or shell radii]
  double strength = 0;  // mean step of brightness across it, outside minus inside [grey levels]
  double coverage = 0;  // share of the directions in view in which it was found
  RingKind kind = RingKind::kUnknown;
};

// What a film tells of the camera and the drum before its balls are looked for.
struct DrumView {
  bool found = false;  // else `caveats` says why, and nothing below holds
  MillCamera
      camera;  // of the pictures that FilmReader hands out; lengths in metres or, without a diameter, shell radii
  Estimate focal, k1, centre_u, centre_v;  // [px]; centre: where the axis pierces the glass
  Estimate obliqueness;                    // of the view against the axis [rad]
  double place_error = kNotGiven;          // RMS over the glass at a given scale, from the covariance [as camera]
  Estimate scale;  // factor on all lengths of `camera`: 1 with its relative standard error, to be bettered by the balls
  RingKind scale_from = RingKind::kUnknown;
  Estimate readout;                          // of a picture, first row to last, in frame periods
  Estimate turn_per_frame;                   // commonest [rad], > 0 counter-clockwise as seen
  std::vector<DrumAngle> angles;             // of the first frames, in order
  int lifter_count = 0;                      // as known, else as seen; 0 where no period stands out
  int lifters_seen = 0;                      // 0 where no period stands out
  double lifter_angle = kNotGiven;           // of one lifter's middle at drum angle 0 [rad]
  std::vector<RingFound> rings;              // innermost first
  cv::Mat hidden;                            // 8 bit, 255 where something that stands still covers the drum
  std::vector<double> hidden_share;          // of the ring just inside the lifter tips, by degree from 3 o'clock
  double in_view = 1;                        // share of the shell that lies within the picture
  std::shared_ptr<const DrumReader> reader;  // the drum's angle in any further picture
  std::vector<std::string> caveats;
};

// Throws InputError where the file is no film. `known`: whatever is known of the mill.
DrumView calibrate_drum(const std::string& film, const Config& known, const Progress& progress);

// The same of pictures from elsewhere, 8-bit BGR of one size; `next` is false after the last one.
using NextPicture = std::function<bool(cv::Mat& bgr)>;
DrumView calibrate_drum(const NextPicture& next, double frames_per_second, const Config& known,
                        const Progress& progress);

}  // namespace tumble::analysis
