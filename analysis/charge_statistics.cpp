#include "analysis/charge_statistics.h"

#include <algorithm>
#include <cmath>

#include "analysis/circulation.h"
#include "core/quantile.h"
#include "core/statistics.h"
#include "core/units.h"

namespace tumble::analysis {

double head_of(std::span<const TrackPoint> balls) {
  if (balls.empty()) return kNotGiven;
  std::vector<double> y;
  for (const TrackPoint& b : balls) y.push_back(b.y);
  std::sort(y.begin(), y.end());
  const double at = 0.99 * static_cast<double>(y.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, y.size() - 1);
  return y[low] + (at - static_cast<double>(low)) * (y[high] - y[low]);
}

Estimate filling_of_deep_mill(const Field& field, double mill_radius, double layers) {
  std::vector<double> dense;
  double covered = 0, scattered = 0, most = 0;
  for (const double o : field.occupancy)
    if (!std::isnan(o)) {
      covered += o * field.cell * field.cell;
      const double each = 1 - std::pow(std::max(0.0, 1 - o), 1 / layers);  // share that one layer covers
      scattered += std::min(1.0, each / kSettledAreaShare) * field.cell * field.cell;
      most = std::max(most, o);
    }
  for (const double o : field.occupancy)
    if (o > 0.5 * most) dense.push_back(o);
  if (dense.empty()) return {};
  const double cross_section = kPi * mill_radius * mill_radius;
  const double high = covered / quantile_of(std::move(dense), 0.9) / cross_section,
               low = std::min(high, scattered / cross_section);
  return {0.5 * (low + high), (high - low) / std::sqrt(12.0)};
}

// At the shell: still within the ring that toe and shoulder are read in. A flight worth the name carries the ball half
// a mill radius; the medians hardly move from there on, while below they follow the hops in the shoulder.
FlightAngles angles_of(std::span<const Flight> flights, const MillGeometry& geometry) {
  return flight_angles(flights, edge_ring(geometry.tip_radius, geometry.mean_diameter).inner, 0.5 * geometry.radius);
}

void put_edges(std::span<const ChargeEdges> frames, std::span<ProfileRow> profile) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    profile[i].toe_deg = frames[i].toe[kHalf];
    profile[i].shoulder_deg = frames[i].shoulder[kHalf];
  }
}

void put_edges(const ChargeEdges& of_mean, ChargeMotion& motion) {
  motion.toe_deg.value = of_mean.toe[kHalf];
  motion.toe_bulk_deg.value = of_mean.toe[kBulk];
  motion.toe_outer_deg.value = of_mean.toe[kOuter];
  motion.shoulder_deg.value = of_mean.shoulder[kHalf];
  motion.shoulder_bulk_deg.value = of_mean.shoulder[kBulk];
  motion.shoulder_outer_deg.value = of_mean.shoulder[kOuter];
}

double circulation_reach(const MillGeometry& geometry) { return 1.5 * geometry.mean_diameter; }

ChargeStatistics::ChargeStatistics(const MillGeometry& geometry)
    : geometry_(geometry),
      ring_(edge_ring(geometry.tip_radius, geometry.mean_diameter)),
      edges_(geometry.passage_frames),
      field_(geometry.radius) {
  if (!std::isnan(geometry.gravity)) flights_.emplace(geometry.gravity);
}

void ChargeStatistics::add(int frame, double time, double mill_angle_deg, std::span<const TrackPoint> balls,
                           const std::vector<bool>& hidden, std::span<const TrackPoint> unseen) {
  std::vector<Disc> discs;
  std::vector<MovingDisc> moving;
  for (const auto& some : {balls, unseen})
    for (const TrackPoint& b : some) {
      discs.push_back({b.x, b.y, b.radius});
      moving.push_back({b.x, b.y, b.radius, b.vx, b.vy});
    }
  RingProfile profile = ring_occupancy(discs, ring_);
  for (std::size_t i = 0; i < hidden.size() && i < profile.size(); ++i)
    if (hidden[i]) profile[i] = kNotGiven;
  edges_.add(profile);
  field_.add(moving);
  ProfileRow row;
  row.frame = frame;
  row.time = time;
  row.mill_angle_deg = mill_angle_deg;
  row.head = head_of(balls);
  if (!std::isnan(row.head)) heads_.push_back(row.head);
  profile_.push_back(row);
  tracks_.append(balls);
  if (flights_) flights_->add(balls);
}

void ChargeStatistics::finish(ChargeMotion& motion) {
  const EdgeEstimates edges = edges_.estimate();
  motion.toe_deg = edges.toe[kHalf];
  motion.toe_bulk_deg = edges.toe[kBulk];
  motion.toe_outer_deg = edges.toe[kOuter];
  motion.shoulder_deg = edges.shoulder[kHalf];
  motion.shoulder_bulk_deg = edges.shoulder[kBulk];
  motion.shoulder_outer_deg = edges.shoulder[kOuter];
  motion.ring_occupancy = edges.occupancy;
  motion.ring_occupancy_se = edges.occupancy_se;

  put_edges(edges_.finish_frames(), profile_);
  motion.profile = std::move(profile_);
  motion.head = mean_of_series(heads_);
  motion.field = field_.field();
  const auto centre = field_.centre_of_circulation(circulation_reach(geometry_));
  motion.centre_of_circulation_x = centre.x;
  motion.centre_of_circulation_y = centre.y;
  const auto surface = field_.surface();
  motion.surface = surface.line;
  motion.surface_angle_deg = surface.angle_deg;
  if (flights_) {
    const auto flights = flights_->finish();
    const FlightAngles angles = angles_of(flights, geometry_);
    motion.departure_deg = angles.departure_deg;
    motion.impact_toe_deg = angles.impact_toe_deg;
    motion.granular_temperature = field_.granular_temperature();
    motion.circulation_time =
        circulation_time(tracks_, field_, centre.x.value, centre.y.value, geometry_.mean_diameter);
    motion.flight_share = flight_share(tracks_, flights);
  }
  motion.tracks = std::move(tracks_);
}

}  // namespace tumble::analysis
