#pragma once
#include <vector>

#include "diagnose/measurement.h"

// Tracking loses a ball now and then, and may find it again under another number. Where it was meanwhile is no secret:
// without it, maps have holes and its neighbours seem to fly freely.
namespace tumble::diagnose {

// The same frames with balls that were lost for up to 0.06 s put back, marked as guessed, straight between their last
// and their next place. A ball that ends and one that begins are the same where their paths meet within a radius.
// Balls of each frame are sorted by number, before and after.
std::vector<SeenFrame> with_lost_balls(std::vector<SeenFrame> frames);

}  // namespace tumble::diagnose
