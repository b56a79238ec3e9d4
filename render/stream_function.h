#pragma once
#include "core/charge_motion.h"
#include "render/contours.h"

namespace tumble::render {

// Stream function psi of the charge's mean flow [m2/s]: dpsi/dy = phi v_x, -dpsi/dx = phi v_y, phi the occupancy and v
// the mean velocity; 0 at the shell. What streams through a cell is balls, and in a steady state none pile up anywhere:
// so phi v, and not v, has no sources, its streamlines are closed, and between two contours of psi flows the difference
// of their levels, as area of balls a second. The measured field has noise; psi is the one whose flow comes nearest to
// it by least squares, weighted by the flow's relative error: so no line strays through the empty part of the mill.
Grid stream_function(const Field& field, double shell_radius);

}  // namespace tumble::render
