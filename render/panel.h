#pragma once
#include <optional>
#include <set>
#include <string>

#include "core/frame.h"
#include "render/canvas.h"
#include "render/charge_view.h"
#include "render/torque_plot.h"

namespace tumble::render {

// The column beside the mill: what mill it is, clock, speed, torque with its trace, and the colour scale. It is drawn
// in two parts: what stands still during a film, and what moves.
struct Panel {
  const RunSetup& setup;
  const TorqueTrace& trace;
  std::optional<TorquePlot> plot;  // where there is a trace
  ColourScale scale;
  double slow = 1;
};

// Where the torque's plot lies, if there is a trace.
std::optional<TorquePlot> place_torque_plot(Canvas& canvas, const TorqueTrace& trace, Colour by);

// `pale`: the torque's curve as what is still to come, or as what has been.
void draw_still_panel(Canvas& canvas, const Panel& panel, bool pale);
void draw_moving_panel(Canvas& canvas, const Panel& panel, const Frame& frame);

// Title, bar and ticks; by size, one ball of each where there are few kinds. Nothing by steel.
void draw_colour_scale(Canvas& canvas, double left, double right, double top, const ColourScale& scale,
                       const std::set<double>& radii);

// How time runs in the film, in words: "true time", "3.3 x slower"; nothing for a still.
std::string time_note(double slow);

// The panel's first two lines.
std::string mill_in_words(const Config& config);
std::string charge_in_words(const RunSetup& setup);

}  // namespace tumble::render
