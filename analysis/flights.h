#pragma once
#include <span>
#include <vector>

#include "core/charge_motion.h"

namespace tumble::analysis {

struct Flight {  // one ball in free fall, from its first to its last moment on the parabola
  int id = 0;
  double start_time = 0, end_time = 0;          // [s]
  double start_x = 0, start_y = 0;              // [m]
  double end_x = 0, end_y = 0;                  // [m]
  bool whole_start = false, whole_end = false;  // false where the track begins or ends in flight
  double hugged = 0;  // degrees round the axis before the start, in which places are hardly off the parabola already
};

// Flights in tracks (any order of rows), found by their acceleration: a parabola with gravity `g` straight down that
// holds for at least kLeastFlight seconds. `g` in the tracks' unit of length.
inline constexpr double kLeastFlight = 0.06;  // [s]; a ball falls 18 mm in it: shorter hops say nothing
std::vector<Flight> find_flights(std::span<const TrackPoint> tracks, double g);

// The same for tracks that come frame by frame, at a memory that does not grow with them.
class FlightLog {
 public:
  explicit FlightLog(double g) : g_(g) {}
  void add(std::span<const TrackPoint> frame);  // times never fall
  std::vector<Flight> finish();

 private:
  void take(double until);  // flights of the recent points that begin before

  double g_, taken_until_ = -1e300;
  std::vector<TrackPoint> recent_;
  std::vector<Flight> flights_;
};

struct FlightAngles {
  Estimate departure_deg;   // median of the angles where balls leave the shell into flight
  Estimate impact_toe_deg;  // median of the angles where these flights end
};

// `shell_reach`: a flight starts at the shell when its start lies at least this far from the axis. `least_length`: from
// start to end; shorter ones are hops within the charge, of which there are many and which have no toe.
FlightAngles flight_angles(std::span<const Flight> flights, double shell_reach, double least_length);

// Share of the balls that are in one of these flights, over all frames.
Estimate flight_share(const Spool<TrackPoint>& tracks, std::span<const Flight> flights);

}  // namespace tumble::analysis
