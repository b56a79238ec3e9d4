#include <cmath>

#include "analysis/charge_motion.h"
#include "analysis/charge_statistics.h"
#include "core/angle.h"
#include "core/mill_shape.h"
#include "core/statistics.h"

namespace tumble::analysis {
namespace {

MillGeometry geometry_of(const RunSetup& setup, const MillShape& shape) {
  MillGeometry g;
  g.radius = shape.radius;
  g.tip_radius = shape.tip_radius;
  for (double r : setup.balls.radius) g.mean_diameter += 2.0 * r / static_cast<double>(setup.balls.size());
  const double lifters = shape.lifter_count > 0 ? shape.lifter_count : kUsualLifters;
  const double speed = std::abs(setup.mill_speed);
  if (speed > 0) g.passage_frames = 2.0 * kPi / (lifters * speed) * setup.config.run.frames_per_second;
  g.gravity = kGravity;
  return g;
}

std::vector<TrackPoint> balls_of(const Frame& frame, const RunSetup& setup, int index) {
  std::vector<TrackPoint> balls(setup.balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    TrackPoint& b = balls[i];
    b.frame = index;
    b.id = static_cast<int>(i);
    b.time = frame.time;
    b.x = frame.x[i];
    b.y = frame.y[i];
    b.vx = frame.vx[i];
    b.vy = frame.vy[i];
    b.radius = setup.balls.radius[i];
    b.spin = frame.spin[i];
  }
  return balls;
}

}  // namespace

ChargeMotion measure_frames(const RunSetup& setup, const NextFrame& next, const Progress& progress) {
  const MillShape shape = make_mill_shape(setup.config.mill);
  ChargeMotion motion;
  motion.source = MotionSource::kRunFile;
  motion.rotation = Rotation::kCounterClockwise;
  motion.lifter_count = shape.lifter_count;
  motion.mill_radius = shape.radius;
  motion.tip_radius = shape.tip_radius;
  motion.frames_per_second = setup.config.run.frames_per_second;
  motion.speed_rpm = {rpm_from_rad_s(setup.mill_speed), 0.0};
  motion.speed_fraction = {motion.speed_rpm.value / critical_speed_rpm(setup.config.mill), 0.0};
  double area = 0;
  for (double r : setup.balls.radius) area += kPi * r * r;
  motion.filling = {area / (kSettledAreaShare * kPi * shape.radius * shape.radius), 0.0};

  ChargeStatistics statistics(geometry_of(setup, shape));
  std::vector<double> torque, closure;
  Frame frame;
  while (next(frame)) {
    statistics.add(motion.frames, frame.time, degrees(frame.mill_angle), balls_of(frame, setup, motion.frames));
    const Observables& o = frame.observed;
    if (!std::isnan(o.torque)) {
      torque.push_back(o.torque);
      motion.torque_series.push_back({frame.time, o.torque, o.power});
    }
    if (!std::isnan(o.torque_closure)) closure.push_back(o.torque_closure);
    ++motion.frames;
    if (setup.frame_count > 0)
      report(progress, static_cast<double>(motion.frames) / static_cast<double>(setup.frame_count));
  }
  statistics.finish(motion);
  motion.torque = mean_of_series(torque);
  motion.torque_closure = mean_of_series(closure);
  return motion;
}

}  // namespace tumble::analysis
