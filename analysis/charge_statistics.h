#pragma once
#include <optional>
#include <span>
#include <vector>

#include "analysis/flights.h"
#include "analysis/toe_shoulder.h"
#include "analysis/velocity_field.h"
#include "core/charge_motion.h"

namespace tumble::analysis {

// Without lifters a passage is taken as that of 18, a usual number: per-frame values need some window.
inline constexpr int kUsualLifters = 18;

// What the ring, the grid and the windows are laid out by. Lengths in the unit of the discs.
struct MillGeometry {
  double radius = 0;           // inside the shell
  double tip_radius = 0;       // of the lifter tips; = radius without lifters
  double mean_diameter = 0;    // number mean of the balls
  double passage_frames = 1;   // frames in one lifter passage
  double gravity = kNotGiven;  // NaN where length or clock is unknown
};

// Of these flights, where they leave the shell of this mill and end.
FlightAngles angles_of(std::span<const Flight> flights, const MillGeometry& geometry);

// Each frame's edges into its row; those of the time mean, without errors, into the motion.
void put_edges(std::span<const ChargeEdges> frames, std::span<ProfileRow> profile);
void put_edges(const ChargeEdges& of_mean, ChargeMotion& motion);

double circulation_reach(const MillGeometry& geometry);  // of the plane whose root is the centre of circulation

// Turns balls seen frame by frame, from truth or from pictures, into toe, shoulder, head, fields and flights: one code
// for both, so that they can differ only in what was seen.
class ChargeStatistics {
 public:
  explicit ChargeStatistics(const MillGeometry& geometry);

  // One frame's balls. `hidden`: bins of the ring that could not be seen. `unseen`: balls that are there, but are not
  // to be told of.
  void add(int frame, double time, double mill_angle_deg, std::span<const TrackPoint> balls,
           const std::vector<bool>& hidden = {}, std::span<const TrackPoint> unseen = {});

  // Fills toe, shoulder, head, centre of circulation, free surface, times and shares, departure, impact, ring
  // occupancy, profile, field and tracks.
  void finish(ChargeMotion& motion);

 private:
  MillGeometry geometry_;
  Ring ring_;
  EdgeStatistics edges_;
  FieldStatistics field_;
  std::vector<double> heads_;
  std::vector<ProfileRow> profile_;
  Spool<TrackPoint> tracks_;
  std::optional<FlightLog> flights_;  // none where length or clock is unknown
};

// Filling of a mill in which `layers` of balls lie behind one another, of which a camera sees what is covered. At most,
// wherever something is seen, all layers are full; at least, every layer is covered by chance, as by balls in flight.
// The truth may lie anywhere between.
Estimate filling_of_deep_mill(const Field& field, double mill_radius, double layers);

// 99th percentile, linear between order statistics; NaN of nothing.
double head_of(std::span<const TrackPoint> balls);

}  // namespace tumble::analysis
