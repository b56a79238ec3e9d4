#pragma once
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "analysis/mill_camera.h"
#include "core/charge_motion.h"
#include "core/image.h"
#include "core/progress.h"
#include "core/spool.h"

namespace tumble::analysis {

struct FoundBall {
  double u = 0, v = 0, radius = 0;  // as seen [px]
  int track = -1;                   // -1: looked at and not believed
};

// What was understood of a film, kept to be drawn over it.
struct FilmFindings {
  MillCamera camera;                  // of the pictures that FilmReader hands out
  double radius = 1, tip_radius = 1;  // [as camera]
  double roll = 0;                    // of the camera [rad]
  bool clockwise = false;
  int lifters = 0;
  double lifter_angle = kNotGiven;  // of one, at drum angle 0, as seen [rad]
  cv::Mat hidden;                   // 8 bit, of the film's own size: 255 where the drum is covered
  std::vector<double> drum;         // its angle, by frame of the file, as seen [rad]
  FrameSpool<FoundBall> balls;      // by frame of the file
};

// The whole film with its findings drawn over it, picture by picture: circle, lifters, balls with the way they came,
// toe and shoulder, what is hidden and what was rejected.
void draw_film(const std::string& film, const FilmFindings& findings, const ChargeMotion& motion,
               const std::function<void(const Image&)>& sink, const Progress& progress);

// Six moments of the film with their findings and the numbers beside: to see at a glance whether to believe them.
// `pictures`: of the sheet's frames, as far as the film goes.
std::vector<int> sheet_frames(int frames);
Image contact_sheet(const std::string& film, const std::vector<int>& frames, const std::vector<cv::Mat>& pictures,
                    const FilmFindings& findings, const ChargeMotion& motion);

}  // namespace tumble::analysis
