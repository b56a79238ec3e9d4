#pragma once
#include <array>
#include <vector>

#include "analysis/ball_mark.h"
#include "core/charge_motion.h"
#include "core/config.h"

namespace tumble::analysis {

// A ball found in one frame: about the mill's axis, x right, y up, any one unit of length.
struct Sighting {
  double x = 0, y = 0;
  double radius = 0;
  double deviation = 0;  // of x and of y, standard
  int size_class = 0;
  double score = 0;               // of the detector, [0, 1]
  double visible = 1;             // share of its disc that nothing hides
  std::array<float, 3> colour{};  // mean of its inner part [grey levels]
  MarkLook mark;
  double u = kNotGiven, v = kNotGiven;           // centre in the picture [px]
  double time = 0;                               // of this ball: recorded frame index, plus its row's delay
  int track = -1;                                // filled by link_sightings; -1: not believed
  double vx = kNotGiven, vy = kNotGiven;         // [length/frame], filled by smooth_velocities; NaN where unknown
  double spin = kNotGiven, spin_se = kNotGiven;  // [rad/frame], filled by measure_spins; NaN where no mark tells
  double confidence = kNotGiven;  // that the link to the sighting before is right, [0, 1]; NaN for the first
};

struct SeenFrame {
  double time = 0;  // recorded frame index
  std::vector<Sighting> balls;
};

struct MotionModel {
  double turn = 0;                      // of the drum per frame, > 0 counter-clockwise [rad]
  double gravity_x = 0, gravity_y = 0;  // [length/frame^2]; 0 where unknown
  double patience = 3;                  // frames that a path waits for its ball to come back
  double longest_gap = 12;              // frames over which ends of paths are joined afterwards
  double shell = kNotGiven;  // radius at which balls lie on it, where places are sharp enough to say so; else NaN
};

// Gives every sighting its path. Balls are carried with the drum, fall freely, or go on as they went; where a path has
// no past, what other balls did at that place is the guess (the frames are gone through twice). Loose ends are then
// joined over longer gaps, all at once and at least total cost. Paths that stand still while the mill turns, and those
// for which too little speaks, are not balls. Returns the number of paths.
int link_sightings(std::vector<SeenFrame>& frames, const MotionModel& model);

// Velocities from parabolas through the sightings of the same path within `window` frames.
void smooth_velocities(std::vector<SeenFrame>& frames, double window);

// Turns places and velocities so that the mill stands upright, and mirrors them and spins where it turns clockwise.
void turn_upright(std::vector<SeenFrame>& frames, double roll, bool clockwise);

// Whether a sighting is told of: it has its path and is more likely a ball than not. Fainter ones only keep paths
// together.
bool is_told(const Sighting& s);

// Where paths say that balls are in frames in which they were not seen, by frame: between two sightings, with their
// velocities.
std::vector<SeenFrame> bridged_sightings(const std::vector<SeenFrame>& frames);

// What is told of a frame, by track. `unit`: metres per length; `rate`: frames per second.
std::vector<TrackPoint> points_of(const SeenFrame& seen, int frame, double unit, double rate);

}  // namespace tumble::analysis
