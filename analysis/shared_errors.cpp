#include "analysis/shared_errors.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "analysis/flights.h"
#include "analysis/toe_shoulder.h"
#include "analysis/velocity_field.h"
#include "core/angle.h"

namespace tumble::analysis {
namespace {

struct Displacement {
  double x = 0, y = 0, scale = 0, roll = 0;
  bool with_unseen = false;

  Eigen::Vector2d operator()(double px, double py) const {
    return (1 + scale) * (Eigen::Rotation2Dd(roll) * Eigen::Vector2d(px, py)) + Eigen::Vector2d(x, y);
  }
};

struct Quantity {
  Estimate ChargeMotion::*of;
  bool is_direction;
};

constexpr std::array<Quantity, 11> kQuantities = {{{&ChargeMotion::toe_deg, true},
                                                   {&ChargeMotion::shoulder_deg, true},
                                                   {&ChargeMotion::toe_bulk_deg, true},
                                                   {&ChargeMotion::shoulder_bulk_deg, true},
                                                   {&ChargeMotion::toe_outer_deg, true},
                                                   {&ChargeMotion::shoulder_outer_deg, true},
                                                   {&ChargeMotion::departure_deg, true},
                                                   {&ChargeMotion::impact_toe_deg, true},
                                                   {&ChargeMotion::head, false},
                                                   {&ChargeMotion::centre_of_circulation_x, false},
                                                   {&ChargeMotion::centre_of_circulation_y, false}}};

// Measures anew, frame by frame, what depends on where the mill is: toe, shoulder, head and flights. The centre of
// circulation is carried along with the balls, unless there are more of them.
class Remeasured {
 public:
  Remeasured(const Displacement& by, const MillGeometry& geometry) : by_(by), geometry_(geometry) {
    if (by.with_unseen) field_.emplace(geometry.radius);
    if (!std::isnan(geometry.gravity)) flights_.emplace(geometry.gravity);
  }
  const Displacement& by() const { return by_; }

  void add(std::span<const TrackPoint> balls, std::span<const TrackPoint> unseen, const std::vector<bool>& hidden) {
    std::vector<Disc> discs;
    std::vector<MovingDisc> moving;
    std::vector<TrackPoint> displaced(balls.begin(), balls.end());
    if (by_.with_unseen) displaced.insert(displaced.end(), unseen.begin(), unseen.end());
    for (TrackPoint& p : displaced) {
      const Eigen::Vector2d place = by_(p.x, p.y);
      p.x = place.x();
      p.y = place.y();
      discs.push_back({p.x, p.y, p.radius});
      if (field_) moving.push_back({p.x, p.y, p.radius, p.vx, p.vy});
    }
    ring_.add(ring_occupancy(discs, edge_ring(geometry_.tip_radius, geometry_.mean_diameter)), hidden);
    if (field_) field_->add(moving);
    const auto seen = std::span(displaced).first(balls.size());
    if (flights_) flights_->add(seen);
    const double head = head_of(seen);
    if (std::isnan(head)) return;
    heads_ += head;
    ++frames_;
  }

  ChargeMotion finish(const ChargeMotion& as_seen) {
    ChargeMotion motion;
    put_edges(find_edges(smooth(ring_.mean(), kMeanBox)), motion);
    motion.head.value = heads_ / frames_;
    if (field_) {
      const auto centre = field_->centre_of_circulation(circulation_reach(geometry_));
      motion.centre_of_circulation_x = centre.x;
      motion.centre_of_circulation_y = centre.y;
    } else {
      const Eigen::Vector2d centre = by_(as_seen.centre_of_circulation_x.value, as_seen.centre_of_circulation_y.value);
      motion.centre_of_circulation_x.value = centre.x();
      motion.centre_of_circulation_y.value = centre.y();
    }
    if (!flights_) return motion;
    const FlightAngles angles = angles_of(flights_->finish(), geometry_);
    motion.departure_deg = angles.departure_deg;
    motion.impact_toe_deg = angles.impact_toe_deg;
    return motion;
  }

 private:
  Displacement by_;
  MillGeometry geometry_;
  RingMean ring_;
  std::optional<FieldStatistics> field_;  // where balls are added
  std::optional<FlightLog> flights_;      // none where length or clock is unknown
  double heads_ = 0, frames_ = 0;
};

}  // namespace

void add_shared_errors(ChargeMotion& motion, const MillGeometry& geometry, const std::vector<bool>& hidden,
                       const FrameSpool<TrackPoint>& unseen, const SharedErrors& errors) {
  std::vector<Remeasured> all;
  for (const double side : {-1.0, 1.0}) {
    if (errors.axis > 0) all.emplace_back(Displacement{side * errors.axis, 0, 0, 0, false}, geometry);
    if (errors.axis > 0) all.emplace_back(Displacement{0, side * errors.axis, 0, 0, false}, geometry);
    if (errors.scale > 0) all.emplace_back(Displacement{0, 0, side * errors.scale, 0, false}, geometry);
    if (errors.roll > 0) all.emplace_back(Displacement{0, 0, 0, side * errors.roll, false}, geometry);
  }
  if (unseen.size() > 0) all.emplace_back(Displacement{0, 0, 0, 0, true}, geometry);

  auto next = motion.tracks.begin();
  const auto end = motion.tracks.end();
  std::vector<TrackPoint> balls, bridged;
  for (std::size_t f = 0; f < motion.profile.size(); ++f) {
    balls.clear();
    for (; !(next == end) && (*next).frame == motion.profile[f].frame; ++next) balls.push_back(*next);
    bridged = f < unseen.size() ? unseen[f] : std::vector<TrackPoint>();
    for (Remeasured& one : all) one.add(balls, bridged, hidden);
  }

  std::array<double, kQuantities.size()> variance{};
  for (Remeasured& one : all) {
    const ChargeMotion off = one.finish(motion);
    const double weight = one.by().with_unseen ? 1.0 : 0.5;  // the others come in pairs
    for (std::size_t i = 0; i < kQuantities.size(); ++i) {
      double change = (off.*kQuantities[i].of).value - (motion.*kQuantities[i].of).value;
      if (kQuantities[i].is_direction) change = wrap_180(change);
      if (!std::isnan(change)) variance[i] += weight * change * change;
    }
  }
  for (std::size_t i = 0; i < kQuantities.size(); ++i) {
    double& se = (motion.*kQuantities[i].of).se;
    se = std::hypot(se, std::sqrt(variance[i]));
  }
}

}  // namespace tumble::analysis
