#include "trials/instruments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

#include "core/units.h"
#include "io/csv_file.h"

namespace tumble::trials {
namespace {

constexpr double kRate = 250;
constexpr std::size_t kBalls = 50;
constexpr int kFrames = 400;

// Balls that stand in a row and spin at 10 rad/s.
Frame frame_at(int k) {
  Frame f;
  f.time = k / kRate;
  f.mill_angle = 4 * f.time;
  for (std::size_t i = 0; i < kBalls; ++i) {
    f.x.push_back(0.01 * double(i));
    f.y.push_back(-0.1);
    f.angle.push_back(10 * f.time);
    f.vx.push_back(0);
    f.vy.push_back(0);
    f.spin.push_back(10);
  }
  return f;
}

io::CsvTable tracked(const TrackingErrors& errors) {
  std::ostringstream out;
  Tracker tracker(out, kRate, {}, errors, 5);
  for (int k = 0; k < kFrames; ++k) tracker.add(frame_at(k));
  tracker.finish();
  return io::parse_csv(out.str(), "tracks");
}

double rms(const std::vector<double>& errors) {
  double sum = 0;
  for (const double e : errors) sum += e * e;
  return std::sqrt(sum / double(errors.size()));
}

TEST(Tracker, ErrsAsItIsTold) {
  TrackingErrors errors;
  errors.place = 0.3e-3;
  errors.angle = 0.5 * kPi / 180;
  const io::CsvTable table = tracked(errors);
  const auto x = table.numbers("x_m"), y = table.numbers("y_m"), spin = table.numbers("spin_rad_s", true);
  std::vector<double> in_x, in_y, in_spin;
  for (std::size_t i = 0; i < x.size(); ++i) {
    in_x.push_back(x[i] - 0.01 * std::round(x[i] / 0.01));
    in_y.push_back(y[i] + 0.1);
    if (!std::isnan(spin[i])) in_spin.push_back(spin[i] - 10);
  }
  EXPECT_NEAR(rms(in_x), 0.3e-3, 0.01e-3);  // 20,000 sightings
  EXPECT_NEAR(rms(in_y), 0.3e-3, 0.01e-3);
  EXPECT_NEAR(rms(in_spin), errors.angle * std::sqrt(2.0) * kRate / 2, 0.03);
}

TEST(Tracker, LosesBallsAndTakesSomeForOthers) {
  const io::CsvTable table = tracked({});
  const auto frame = table.numbers("frame"), id = table.numbers("id"), time = table.numbers("time_s");
  const double lost = 1 - double(frame.size()) / (kBalls * kFrames);
  EXPECT_GT(lost, 0.005);
  EXPECT_LT(lost, 0.02);
  EXPECT_GT(std::set<double>(id.begin(), id.end()).size(), kBalls);
  std::set<std::pair<double, double>> seen;
  for (std::size_t i = 0; i < id.size(); ++i) {
    EXPECT_TRUE(seen.emplace(frame[i], id[i]).second);
    EXPECT_NEAR(time[i], frame[i] / kRate, 1e-7);
  }
  EXPECT_EQ(frame.back(), kFrames - 1);
}

TEST(Tracker, ObserversErrInLengthAndDirection) {
  Frame f = frame_at(100);
  const Frame seen = as_seen(f, {.scale = 0.02, .rotation = 0.1});
  EXPECT_NEAR(std::hypot(seen.x[7], seen.y[7]), 1.02 * std::hypot(f.x[7], f.y[7]), 1e-12);
  EXPECT_NEAR(std::atan2(seen.y[7], seen.x[7]), std::atan2(f.y[7], f.x[7]) + 0.1, 1e-12);
  EXPECT_NEAR(seen.mill_angle, f.mill_angle + 0.1, 1e-12);
}

// A torque that grows evenly, metered at 245 per second, told at 250 and 100: each sample is the ramp half an interval
// before its time.
TEST(TorqueMeter, TellsMeansOverIntervalsOfItsOwn) {
  TorqueMeter meter;
  for (int k = 0; k <= 490; ++k) {
    Frame f;
    f.time = k / 245.0;
    f.observed.torque = 3 + 2 * (f.time - 0.5 / 245);  // mean since the last frame
    meter.add(f);
  }
  for (const double rate : {250.0, 100.0}) {
    const std::vector<double> series = meter.series(rate, static_cast<std::size_t>(rate));
    for (std::size_t i = 1; i < series.size(); ++i)
      EXPECT_NEAR(series[i], 3 + 2 * (double(i) / rate - 0.5 / rate), 5e-3) << i << " at " << rate;
  }
  EXPECT_NEAR(meter.mean(2), 5, 1e-9);
}

}  // namespace
}  // namespace tumble::trials
