#pragma once
#include <functional>
#include <optional>

#include "core/checkpoint.h"
#include "core/frame.h"
#include "core/progress.h"
#include "sim/outside_force.h"

// Front door of sim: Config -> frames. Knows no file format: frames go to a callback.
namespace tumble::sim {

// What the caller wants to see of a run; any may be empty. Called from the calling thread, in this order.
struct RunSink {
  std::function<void(const RunSetup&)> setup;         // once, before the first frame (also when resumed)
  std::function<void(const Frame&)> frame;            // every written frame, after spin-up
  std::function<void(const Checkpoint&)> checkpoint;  // now and then, and right after a frame: a run may go on from it
  Progress progress;                                  // share of the whole run, spin-up included
};

// Runs the mill. Throws InputError for a config that is incomplete or has an unstable time step, WorkError when the
// run leaves physics (NaN, overlap beyond half a radius), with step, time and ball.
// `resume`: a checkpoint of the same config; the frames that follow have the same bits as an undisturbed run's.
// `outside`: acts from the moment the mill begins to turn; empty, it costs nothing and changes no bit.
RunResult simulate(const Config& config, const RunSink& sink, std::optional<StoredCheckpoint> resume = {},
                   OutsideForce outside = {});

// Upper bound of Checkpoint::size for this config, for writers that set space aside.
std::size_t checkpoint_capacity(const Config& config);

}  // namespace tumble::sim
