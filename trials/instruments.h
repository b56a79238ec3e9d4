#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/random.h"
#include "diagnose/observation.h"

// What a laboratory's instruments make of a mill: balls followed through a film with marks on them, and a torque
// sensor.
namespace tumble::trials {

struct TrackingErrors {        // one standard deviation each
  double place = 0.3e-3;       // of a ball's centre, x and y [m]
  double angle = 0.0087;       // of a ball's mark [rad]
  double radius = 0.1e-3;      // of a ball in one frame [m]
  double mill_angle = 0.0017;  // of the lifters [rad]
};

// What an observer who errs in length and direction sees of a frame. The clock is the caller's: whose frames are taken
// (1 + clock) times as often as he believes.
Frame as_seen(Frame frame, const diagnose::Observer& observer);

// Writes tracks as `tracks` of EXPERIMENTS.toml wants them, frame by frame as they come. Balls get lost now and then,
// and come back as new ones if they were away for long; spins are differences of the marks' angles from frame to frame.
class Tracker {
 public:
  // `rate`: frames per second as the camera believes; `radius`: of the balls, empty where all are alike and so known.
  Tracker(std::ostream& out, double rate, std::vector<double> radius, const TrackingErrors& errors, std::uint64_t seed);

  void add(const Frame& frame);  // as seen
  void finish();                 // writes what waited for one frame more

 private:
  struct Row {
    int id = -1;  // -1: not seen
    double x = 0, y = 0, angle = 0;
  };
  void write(const std::vector<Row>* before, const std::vector<Row>& now, const std::vector<Row>* after,
             double mill_angle);

  std::ostream* out_;
  double rate_;
  std::vector<double> radius_;
  TrackingErrors errors_;
  Random random_;
  int decimals_;
  std::vector<int> id_, away_, back_in_;  // by ball: its number; frames since it was lost; frames until it is found
  int next_id_ = 0;
  std::vector<std::vector<Row>> window_;  // the last two frames
  double mill_angle_ = 0;                 // of the newest
  double turned_before_ = 0;              // whole turns before the first frame [rad]
  long frames_ = 0, written_ = 0;
};

// Mean torque over even intervals, from frames at any other rate.
class TorqueMeter {
 public:
  void add(const Frame& frame);                                        // true ones
  double mean(double seconds) const;                                   // over the first `seconds`
  std::vector<double> series(double rate, std::size_t samples) const;  // sample i: mean over 1/rate up to time i/rate

 private:
  double impulse_at(double time) const;
  std::vector<double> time_, impulse_;  // impulse from the first frame on [N m s]
  double first_ = 0;
};

}  // namespace tumble::trials
