#pragma once
#include <span>
#include <string>
#include <vector>

#include "analysis/ball_plane.h"
#include "analysis/drum_calibration.h"
#include "analysis/film_pass.h"
#include "analysis/tracking.h"
#include "core/config.h"

namespace tumble::analysis {

constexpr double kSeenWell = 0.5;  // share of the shell in the picture, for axis, radius and speed to be as usual
constexpr double kOneSided =
    0.05;  // of radius and speed told by one side: what lies deeper seems to be elsewhere there

// Where the mill is in a film's pictures, and in which unit its lengths are.
struct FilmScene {
  DrumView drum;
  Circle bound;       // round everything inside the shell [px]
  double radius = 1;  // of the shell, in the camera's unit
  double tip_radius = 1;
  double pixels_per_unit = 1;       // in the middle of the glass
  std::vector<double> radii;        // of the size classes, in the camera's unit
  double metres = kNotGiven;        // per unit; NaN where nothing tells
  Estimate shell_by_balls;          // as in ChargeMotion
  bool from_afar = false;           // drawn without perspective: depth does not show
  bool one_layer = true;            // of balls; else they lie behind one another
  double place_error = 0;           // relative standard error of all places together
  double glass_error = 0;           // and of the scale in the plane of the glass
  double layer_length = kNotGiven;  // of a mill so shallow that balls hardly hide one another; NaN: unknown
};

FilmScene make_scene(DrumView drum, const Config& known);

void multiply_lengths(FilmScene& scene, double factor);

// Lengths by the balls, from a sample of the film's frames: where mill and balls are both known, they better the
// camera's scale; where one is missing, the balls' touching gives their size in the unit of the other. `seen` radii: of
// the size classes [px]; `sizes`: true ones [m], or empty.
void settle_lengths(FilmScene& scene, const FilmPass& pass, const std::vector<double>& seen_radii,
                    const std::vector<double>& sizes, double mill_length, std::vector<std::string>& caveats);

// Places of a frame's balls as for balls that touch the inside of the front glass, as the camera sees them. `time`: its
// recorded index. What lies beyond the shell, or where no second ball can be, is left out.
SeenFrame places_of(std::span<const FilmBall> balls, double time, const FilmScene& scene);

// Bins of the ring, upright and counter-clockwise, of which half and more is covered by what stands still (`share`, by
// degree as seen), or that balls behind it would reach into: those are not found. `reach`: of a ball along the ring
// [rad].
std::vector<bool> hidden_bins(const std::vector<double>& share, double roll_deg, bool clockwise, double reach);

}  // namespace tumble::analysis
