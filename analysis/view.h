#pragma once
#include <string>
#include <vector>

#include "analysis/ball_detector.h"
#include "analysis/circles.h"
#include "core/charge_motion.h"
#include "core/config.h"

namespace tumble::analysis {

// Where the mill lies in the picture, and how large things are.
struct MillView {
  Circle mill;            // the inner shell [px]
  double tip_radius = 0;  // of the lifter tips [px]
  double metres_per_pixel = kNotGiven;
  std::vector<double> radii;        // true ones of the size classes [px]
  double shift_u = 0, shift_v = 0;  // from detected centres to true ones, in radii: light falls on all balls alike
};

// True centre of a detected ball [px], v down, and about the mill's axis [px], y up, as the camera sees it.
cv::Point2d true_centre(const Detection& ball, const MillView& view);
cv::Point2d about_axis(const Detection& ball, const MillView& view);

// Ball radii that the config names [m], ascending; empty where it names none.
std::vector<double> known_radii(const Config& known);

// The circles of the stills' mean picture, and what they are about: the mill's centre and the largest circle that
// encloses the drum.
struct DrumOutline {
  std::vector<RingEdge> rings;  // strongest first
  Circle centre;
};
Circle enclosing_circle(const std::vector<RingEdge>& rings);

// The shell is where balls stop that lie against it, put onto the nearest circular edge; scale from what is known:
// the mill's diameter, else the balls' sizes, else none.
MillView find_view(const std::vector<std::vector<Detection>>& balls, const BallLook& look, const DrumOutline& outline,
                   const Config& known, std::vector<std::string>& caveats);

// Places and lengths in pixels of enlarged pictures become those of the film itself.
void shrink_to_film(ChargeMotion& motion, int enlarged);

// Lengths of a motion measured without a scale become NaN; angles, pixels and shares stay. A caveat says so.
void forget_lengths(ChargeMotion& motion);

}  // namespace tumble::analysis
