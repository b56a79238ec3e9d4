#pragma once
#include <optional>
#include <vector>

#include "analysis/bed_times.h"
#include "io/run_file.h"
#include "render/renderer.h"
#include "sim/frame_forces.h"

namespace tumble::cli {

// What a picture shows of a run that no frame holds by itself: contact forces, times in the bed. Works out only what
// the style asks for.
class BallInsight {
 public:
  // `truth`: the run's measured motion; needed for times in the bed alone.
  BallInsight(const io::RunReader& run, const ChargeMotion& truth, const render::Style& style);

  struct Moment {
    std::vector<ContactForce> contacts;
    std::vector<double> of_ball;  // by the style's colour
  };
  // At any time of the run. Between stored frames each force runs straight from one to the other: interpolated places
  // are far too coarse for overlaps.
  Moment at(double time);

  // Ends of the scales, of the whole run.
  double residence_top() const;  // which one stay in twenty exceeds [s]
  double force_top();            // of colours and chains, which one contact in a hundred exceeds [N]

 private:
  const std::vector<ContactForce>& stored(std::size_t frame);

  const io::RunReader& run_;
  render::Style style_;
  std::optional<sim::FrameForces> forces_;
  std::optional<analysis::BedTimes> bed_;
  struct Stored {
    std::size_t frame = static_cast<std::size_t>(-1);
    std::vector<ContactForce> contacts;
  };
  Stored stored_[2];  // of even and odd frames
};

}  // namespace tumble::cli
