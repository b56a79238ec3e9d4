#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/mill_camera.h"
#include "core/spool.h"
#include "core/statistics.h"

// What is known of a charge in motion, by truth (run file) or by measurement (film): one type for both, so that
// comparing is trivial and every film of a simulated mill has its exact answer. Conventions: docs/conventions.md.
namespace tumble {

enum class Rotation { kUnknown, kCounterClockwise, kClockwise };  // as seen by the camera, before mirroring
enum class MotionSource { kRunFile, kFilm, kStills, kTracks };

inline const char* name_of(Rotation rotation) {
  switch (rotation) {
    case Rotation::kCounterClockwise:
      return "counter_clockwise";
    case Rotation::kClockwise:
      return "clockwise";
    case Rotation::kUnknown:
      break;
  }
  return "unknown";
}

inline const char* name_of(MotionSource source) {
  switch (source) {
    case MotionSource::kRunFile:
      return "run_file";
    case MotionSource::kFilm:
      return "film";
    case MotionSource::kTracks:
      return "tracks";
    case MotionSource::kStills:
      break;
  }
  return "stills";
}

struct ProfileRow {  // one frame
  int frame = 0;     // of the file, 0-based
  double time = 0;   // [s]
  double mill_angle_deg = kNotGiven;
  double toe_deg = kNotGiven;
  double shoulder_deg = kNotGiven;
  double head = kNotGiven;  // [m]
};

struct TrackPoint {  // one ball seen in one frame
  int frame = 0;
  int id = 0;
  double time = 0;                            // [s]
  double x = 0, y = 0;                        // [m]
  double vx = kNotGiven, vy = kNotGiven;      // [m/s]
  double radius = kNotGiven;                  // [m]
  double spin = kNotGiven;                    // [rad/s]
  double u_px = kNotGiven, v_px = kNotGiven;  // centre in the film's own pixels, v down; NaN for run files
  double x_se = kNotGiven;                    // standard error of x and of y [m]; this and what follows: films only
  double visible = kNotGiven;                 // share of its disc that is seen, [0, 1]
  double confidence = kNotGiven;              // that the link to the sighting before is right, [0, 1]
};

struct Field {      // on a square grid over the mill, row by row from the lowest y; NaN where nothing is known
  double cell = 0;  // edge [m]
  int n = 0;        // cells along x and y; the grid is centred on the axis
  std::vector<double> occupancy, occupancy_se;  // share of the area covered by balls, time mean
  std::vector<double> vx, vy, vx_se, vy_se;     // mean ball velocity [m/s]
  std::vector<double> temperature;              // granular temperature, <(v - <v>)^2> / 2 [m2/s2]
};

struct SurfacePoint {     // of the charge's free surface
  double x = 0, y = 0;    // [m]
  double se = kNotGiven;  // across the bed's middle: along the direction in which the charge lies [m]
};

struct TorqueRow {
  double time = 0;    // [s]
  double torque = 0;  // of one slice [N m]
  double power = 0;   // [W]
};

struct CameraView {                // films and stills only
  double centre_u_px = kNotGiven;  // of the inner shell
  double centre_v_px = kNotGiven;
  double radius_px = kNotGiven;
  double metres_per_pixel = kNotGiven;
  Estimate roll_deg;
  Estimate k1;  // radial distortion, as OpenCV has it: of the square of the distance from the middle in focal lengths
  int width_px = 0, height_px = 0;
  double centre_u_px_se = kNotGiven, centre_v_px_se = kNotGiven;  // standard errors
  double radius_px_se = kNotGiven, metres_per_pixel_se = kNotGiven;
  // The whole camera, of the upright mill frame (not mirrored), lengths in shell radii; none for stills and tracks.
  std::optional<MillCamera> lens;
};

inline std::array<double, 360> unknown_ring() {
  std::array<double, 360> ring;
  ring.fill(kNotGiven);
  return ring;
}

struct ChargeMotion {
  MotionSource source = MotionSource::kRunFile;
  std::string origin;  // the file's name
  Rotation rotation = Rotation::kUnknown;
  int lifter_count = 0;            // 0 where unknown or none
  int lifters_seen = 0;            // films: how many go round in the pictures, whatever is known; 0 where none show
  Estimate shell_by_balls;         // films: R by the balls' given sizes over the given R; NaN where not both are given
  double mill_radius = kNotGiven;  // R [m]
  double tip_radius = kNotGiven;   // [m]
  int frames = 0;
  double frames_per_second = kNotGiven;  // true ones
  double frames_per_second_se = kNotGiven;
  std::vector<int> duplicated_frames, dropped_frames;

  Estimate speed_rpm, speed_fraction, filling;
  Estimate toe_deg, shoulder_deg, toe_bulk_deg, shoulder_bulk_deg, toe_outer_deg, shoulder_outer_deg;
  Estimate head;                                              // [m]
  Estimate centre_of_circulation_x, centre_of_circulation_y;  // [m]
  Estimate departure_deg, impact_toe_deg;
  Estimate surface_angle_deg;       // dynamic angle of repose: of the free surface's middle half against the horizontal
  Estimate flight_share;            // of the balls, in free fall
  Estimate circulation_time;        // of a full turn about the centre of circulation, in the charge [s]
  Estimate granular_temperature;    // mean over the charge [m2/s2]
  Estimate torque, torque_closure;  // of one slice [N m]; run files only
  CameraView camera;

  std::array<double, 360> ring_occupancy{};  // time mean, bin i = [i, i + 1) degrees; NaN where hidden
  std::array<double, 360> ring_occupancy_se = unknown_ring();  // NaN where unknown
  std::vector<ProfileRow> profile;
  Spool<TrackPoint> tracks;           // by frame, then id
  std::vector<SurfacePoint> surface;  // from toe to shoulder
  std::vector<TorqueRow> torque_series;
  Field field;
  std::vector<std::string> caveats;  // what a user must know before believing the numbers
};

}  // namespace tumble
