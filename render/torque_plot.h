#pragma once
#include <span>
#include <vector>

#include "render/canvas.h"

namespace tumble::render {

// The torque of a whole run and its running mean over one lifter passage.
class TorqueTrace {
 public:
  TorqueTrace() = default;  // no trace
  // Times [s] rise; torque [N m]; passage [s].
  TorqueTrace(std::span<const double> time, std::span<const double> torque, double passage);

  bool empty() const { return sums_.empty(); }                                     // none, or one that cannot be drawn
  bool is_of(std::span<const double> time, std::span<const double> torque) const;  // built from just these numbers
  double running(double time) const;                                               // [N m], NaN without a trace
  double mean() const;  // of the whole run [N m], NaN without a trace

  const std::vector<double>& time() const { return time_; }
  const std::vector<double>& torque() const { return torque_; }

 private:
  std::vector<double> time_, torque_;
  std::vector<double> sums_;  // of the first n samples: any running mean is one subtraction
  double passage_ = 0;
};

// Where the plot lies in the picture, and its scales.
struct TorquePlot {
  Box box;                    // of the curve, without the axes' labels
  double start = 0, end = 0;  // [s]
  double low = 0, high = 0;   // [N m]
  double x_of(double time) const;
  double y_of(double torque) const;
};

// The plot fills `area` with its labels. Expects a trace that is not empty.
TorquePlot make_torque_plot(Canvas& canvas, const Box& area, const TorqueTrace& trace);

// Axes, the band from smallest to largest, the running mean, the whole run's mean; pale for what is still to come,
// with the axes' numbers: the bright one is only ever seen inside the box.
void draw_torque_curve(Canvas& canvas, const TorquePlot& plot, const TorqueTrace& trace, bool pale);
void draw_torque_cursor(Canvas& canvas, const TorquePlot& plot, const TorqueTrace& trace, double now);

}  // namespace tumble::render
