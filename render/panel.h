#pragma once
#include <string>

#include "core/frame.h"
#include "render/canvas.h"
#include "render/charge_view.h"
#include "render/torque_plot.h"

namespace tumble::render {

// The column beside the mill: what mill it is, clock, speed, torque with its trace, and the colour scale.
void draw_panel(Canvas& canvas, const RunSetup& setup, const Frame& frame, const TorqueTrace& trace,
                const ColourScale& scale, double slow);

// How time runs in the film, in words: "true time", "3.3 x slower".
std::string time_note(double slow);

// The panel's first two lines.
std::string mill_in_words(const Config& config);
std::string charge_in_words(const RunSetup& setup);

}  // namespace tumble::render
