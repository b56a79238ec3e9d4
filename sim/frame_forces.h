#pragma once
#include <memory>
#include <vector>

#include "core/contact_force.h"
#include "core/frame.h"

namespace tumble::sim {

// The normal forces of a written frame, worked out again from its positions and velocities by the run's own contact law
// (springs, dashpot, Hertz, cohesion, restitution that falls with the impact). What a frame does not hold is left out:
// tangential forces and rolling resistance hang on each contact's past, and the dashpot takes the velocities of the
// frame where the simulation foresees those at the step's end. A run file's positions are rounded to single precision:
// of that comes an error of up to 2.4e-7 R k_n [N] (0.03 N in the 1992 paper's mill, whose lightest ball weighs
// 0.6 N), and overlaps below it are no contacts.
class FrameForces {
 public:
  explicit FrameForces(const RunSetup& setup);
  ~FrameForces();
  FrameForces(FrameForces&&) noexcept;

  // Balls first, by i and j; then what touches the shell, by i.
  std::vector<ContactForce> at(const Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::sim
