#pragma once
#include <cstddef>
#include <functional>

#include "analysis/tracking.h"

namespace tumble::analysis {

// Consecutive frames of a film, by index; the same whenever asked.
using PlacesOf = std::function<SeenFrame(std::size_t)>;

// How a film is cut for linking, so that memory does not grow with it.
struct Chapters {
  std::size_t length = 0;   // frames of each, the overlap with the next included
  std::size_t overlap = 0;  // frames that two neighbours share: by these, paths are known again
};

// Long enough for the drum to turn once (what rides it is told by that) and for gaps to be short beside it. `turn`: of
// the drum per frame [rad].
Chapters chapters_of(double turn);

// Gets a frame's sightings, and the balls that paths bridge in it.
using UseFrame = std::function<void(std::size_t, const SeenFrame& seen, const SeenFrame& bridged)>;

// Links sightings chapter by chapter; `finish` works on a whole linked chapter, `use` gets every frame once and in
// order, with tracks that are numbered alike throughout.
void link_in_chapters(std::size_t frames, const PlacesOf& places, const Chapters& chapters, const MotionModel& model,
                      const std::function<void(std::vector<SeenFrame>&)>& finish, const UseFrame& use);

}  // namespace tumble::analysis
