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

struct FrameMeasurer::State {
  State(const RunSetup& of, const MillShape& shape) : setup(of), statistics(geometry_of(of, shape)) {}

  RunSetup setup;
  ChargeStatistics statistics;
  ChargeMotion motion;
  std::vector<double> torque, closure;
};

FrameMeasurer::FrameMeasurer(const RunSetup& setup) {
  const MillShape shape = make_mill_shape(setup.config);
  state_ = std::make_unique<State>(setup, shape);
  ChargeMotion& motion = state_->motion;
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
}

FrameMeasurer::~FrameMeasurer() = default;

void FrameMeasurer::add(const Frame& frame) {
  State& s = *state_;
  add(frame.time, frame.mill_angle, balls_of(frame, s.setup, s.motion.frames));
  const Observables& o = frame.observed;
  if (!std::isnan(o.torque)) {
    s.torque.push_back(o.torque);
    s.motion.torque_series.push_back({frame.time, o.torque, o.power});
  }
  if (!std::isnan(o.torque_closure)) s.closure.push_back(o.torque_closure);
}

void FrameMeasurer::add(double time, double mill_angle, std::span<const TrackPoint> balls) {
  State& s = *state_;
  s.statistics.add(s.motion.frames++, time, degrees(mill_angle), balls);
}

ChargeMotion FrameMeasurer::finish() {
  State& s = *state_;
  s.statistics.finish(s.motion);
  s.motion.torque = mean_of_series(s.torque);
  s.motion.torque_closure = mean_of_series(s.closure);
  return std::move(s.motion);
}

ChargeMotion measure_frames(const RunSetup& setup, const NextFrame& next, const Progress& progress) {
  FrameMeasurer measurer(setup);
  Frame frame;
  for (std::int64_t done = 1; next(frame); ++done) {
    measurer.add(frame);
    if (setup.frame_count > 0) report(progress, static_cast<double>(done) / static_cast<double>(setup.frame_count));
  }
  return measurer.finish();
}

struct MeansMeasurer::State {
  Ring ring;
  std::vector<Disc> discs;
  RingMean mean;
  std::vector<double> torque, closure;
};

MeansMeasurer::MeansMeasurer(const RunSetup& setup) : state_(std::make_unique<State>()) {
  const MillGeometry geometry = geometry_of(setup, make_mill_shape(setup.config));
  state_->ring = edge_ring(geometry.tip_radius, geometry.mean_diameter);
  for (const double radius : setup.balls.radius) state_->discs.push_back({0, 0, radius});
}

MeansMeasurer::~MeansMeasurer() = default;

void MeansMeasurer::add(const Frame& frame) {
  State& s = *state_;
  for (std::size_t i = 0; i < s.discs.size(); ++i) s.discs[i].x = frame.x[i], s.discs[i].y = frame.y[i];
  s.mean.add(ring_occupancy(s.discs, s.ring), {});
  if (!std::isnan(frame.observed.torque)) s.torque.push_back(frame.observed.torque);
  if (!std::isnan(frame.observed.torque_closure)) s.closure.push_back(frame.observed.torque_closure);
}

ChargeMotion MeansMeasurer::finish() const {
  ChargeMotion motion;
  put_edges(find_edges(smooth(state_->mean.mean(), kMeanBox)), motion);
  motion.torque = mean_of_series(state_->torque);
  motion.torque_closure = mean_of_series(state_->closure);
  return motion;
}

std::vector<ProfileRow> measure_edges(const RunSetup& setup, const NextFrame& next, const Progress& progress) {
  const MillGeometry geometry = geometry_of(setup, make_mill_shape(setup.config));
  const Ring ring = edge_ring(geometry.tip_radius, geometry.mean_diameter);
  EdgeStatistics edges(geometry.passage_frames);
  std::vector<ProfileRow> rows;
  std::vector<Disc> discs(setup.balls.size());
  for (Frame frame; next(frame);) {
    for (std::size_t i = 0; i < discs.size(); ++i) discs[i] = {frame.x[i], frame.y[i], setup.balls.radius[i]};
    edges.add(ring_occupancy(discs, ring));
    ProfileRow& row = rows.emplace_back();
    row.frame = static_cast<int>(rows.size()) - 1;
    row.time = frame.time;
    row.mill_angle_deg = degrees(frame.mill_angle);
    if (setup.frame_count > 0) report(progress, double(rows.size()) / double(setup.frame_count));
  }
  put_edges(edges.finish_frames(), rows);
  return rows;
}

}  // namespace tumble::analysis
