#pragma once
#include <vector>

#include "core/charge_motion.h"
#include "core/mill_shape.h"
#include "render/canvas.h"
#include "render/contours.h"
#include "render/renderer.h"

namespace tumble::render {

// The lines of a run's mean motion, in the mill's own plane: worked out once, drawn in every picture.
struct MeanView {
  struct Level {
    double value = 0;
    std::vector<Contour> lines;
  };
  std::vector<Level> occupancy;      // at 0.2, 0.4, 0.6, 0.8
  std::vector<Contour> streamlines;  // equal flow between neighbours, in the flow's direction
  std::vector<Contour> surface;
  Field field;                                        // for the arrows
  double head = kNotGiven;                            // [m]
  double centre_x = kNotGiven, centre_y = kNotGiven;  // of circulation [m]
  double departure_deg = kNotGiven, impact_toe_deg = kNotGiven;
};

// `pixel`: its size, which fixes how smooth lines need to be [m].
MeanView make_mean_view(const ChargeMotion& motion, const Overlay& wanted, double pixel);

// What lies over the charge: contours, streamlines, arrows (`arrow_seconds` of motion long), free surface, head and
// centre of circulation.
void draw_mean(Canvas& canvas, const MillShape& shape, const MeanView& mean, const Overlay& overlay,
               double arrow_seconds);

}  // namespace tumble::render
