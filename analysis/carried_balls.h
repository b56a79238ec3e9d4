#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/pixel_tracks.h"
#include "core/statistics.h"

// The mill's axis and speed from the balls alone: those at the shell and deep in the charge turn about the axis, all at
// the drum's speed. Balls that slip, roll or fly agree with no such centre.
namespace tumble::analysis {

struct PixelPoint {
  double u = 0, v = 0;  // [px], v down
};

struct Turning {
  bool found = false;
  PixelPoint centre;
  double centre_se = kNotGiven;  // along either axis [px]; 0 where it was given
  Estimate turn_per_frame;       // > 0: counter-clockwise as seen [rad]
};

// `centre`: where it is known. Not found: fewer than three arcs agree.
Turning find_turning(std::span<const PixelSighting> sightings, const std::optional<PixelPoint>& centre = {});

struct Shell {
  PixelPoint centre;
  double radius = 0;  // inside [px]
};

// The circle that the outermost balls touch from inside. Balls seldom touch it all round, so the centre is drawn to
// `centre` as its error there demands: 0 holds it.
Shell find_shell(std::span<const PixelSighting> sightings, const PixelPoint& centre, double centre_se);

}  // namespace tumble::analysis
