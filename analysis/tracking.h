#pragma once
#include <vector>

namespace tumble::analysis {

// A ball found in one frame: about the mill's axis, x right, y up, the mill turning counter-clockwise. Lengths here and
// below in pixels, time in frames.
struct Sighting {
  double x = 0, y = 0;
  double radius = 0;
  int size_class = 0;
  double score = 0;       // of the detector
  int track = -1;         // filled by link_sightings; -1: not believed
  double vx = 0, vy = 0;  // [px/frame], filled by smooth_velocities; NaN where unknown
};

struct MotionModel {
  double turn = 0;         // of the drum per frame [rad]
  double gravity = 0;      // [px/frame^2]; 0 where unknown
  double tip_radius = 0;   // of the lifters
  double birth_score = 0;  // a path starts only at balls at least as clear as this
  int patience = 3;        // frames that a path survives unseen
};

// Gives every sighting its path. Balls are carried with the drum, fall freely, or go on as they went; where a path has
// no past, what other balls did at that place is the guess (the film is gone through twice). Paths that stand still
// while the mill turns are not balls. Returns the number of paths.
int link_sightings(std::vector<std::vector<Sighting>>& frames, const MotionModel& model);

// Velocities from parabolas through `window` neighbouring sightings (odd) of the same path.
void smooth_velocities(std::vector<std::vector<Sighting>>& frames, int window);

}  // namespace tumble::analysis
