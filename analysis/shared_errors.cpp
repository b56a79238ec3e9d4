#include "analysis/shared_errors.h"

#include <array>
#include <cmath>

#include "core/angle.h"

namespace tumble::analysis {
namespace {

struct Displacement {
  double x = 0, y = 0, scale = 0, roll = 0;
  bool with_unseen = false;
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

using Unseen = FrameSpool<TrackPoint>;

ChargeMotion measured_with(const ChargeMotion& motion, const MillGeometry& geometry, const std::vector<bool>& hidden,
                           const Unseen& unseen, const Displacement& by) {
  ChargeStatistics statistics(geometry);
  const double c = (1 + by.scale) * std::cos(by.roll), s = (1 + by.scale) * std::sin(by.roll);
  const auto displaced = [&](TrackPoint p) {
    const double x = p.x, y = p.y;
    p.x = c * x - s * y + by.x;
    p.y = s * x + c * y + by.y;
    return p;
  };
  auto next = motion.tracks.begin();
  const auto end = motion.tracks.end();
  std::vector<TrackPoint> balls, bridged;
  for (std::size_t f = 0; f < motion.profile.size(); ++f) {
    const ProfileRow& row = motion.profile[f];
    balls.clear();
    bridged.clear();
    for (; !(next == end) && (*next).frame == row.frame; ++next) balls.push_back(displaced(*next));
    if (by.with_unseen && f < unseen.size())
      for (const TrackPoint& p : unseen[f]) bridged.push_back(displaced(p));
    statistics.add(row.frame, row.time, row.mill_angle_deg, balls, hidden, bridged);
  }
  ChargeMotion result;
  statistics.finish(result);
  return result;
}

}  // namespace

void add_shared_errors(ChargeMotion& motion, const MillGeometry& geometry, const std::vector<bool>& hidden,
                       const Unseen& unseen, const SharedErrors& errors) {
  std::array<double, kQuantities.size()> variance{};
  const auto add = [&](const Displacement& by, double weight) {
    const ChargeMotion off = measured_with(motion, geometry, hidden, unseen, by);
    for (std::size_t i = 0; i < kQuantities.size(); ++i) {
      double change = (off.*kQuantities[i].of).value - (motion.*kQuantities[i].of).value;
      if (kQuantities[i].is_direction) change = wrap_180(change);
      if (!std::isnan(change)) variance[i] += weight * change * change;
    }
  };
  for (const double side : {-1.0, 1.0}) {
    if (errors.axis > 0) add({side * errors.axis, 0, 0, 0, false}, 0.5);
    if (errors.axis > 0) add({0, side * errors.axis, 0, 0, false}, 0.5);
    if (errors.scale > 0) add({0, 0, side * errors.scale, 0, false}, 0.5);
    if (errors.roll > 0) add({0, 0, 0, side * errors.roll, false}, 0.5);
  }
  if (unseen.size() > 0) add({0, 0, 0, 0, true}, 1.0);
  for (std::size_t i = 0; i < kQuantities.size(); ++i) {
    double& se = (motion.*kQuantities[i].of).se;
    se = std::hypot(se, std::sqrt(variance[i]));
  }
}

}  // namespace tumble::analysis
