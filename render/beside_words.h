#pragma once
#include "core/frame.h"
#include "render/beside.h"
#include "render/canvas.h"

namespace tumble::render {

// What is the film's is orange, what is the run's is blue: a pair that colour-blind eyes tell apart.
inline constexpr Rgba kFilmInk{255, 166, 64}, kRunInk{86, 196, 255};

// Where things stand [px]. Two squares side by side (or one above the other) with a line of words each, or one square
// with a column of words beside it.
struct BesidePlan {
  BesidePlan(Canvas& canvas, BesideView view);
  struct Place {
    int left = 0, top = 0;
  };
  int edge = 0;
  double margin = 1.14;
  Place film, run;  // of the squares' corners; the same where there is one
  bool two = false, stacked = false;
};

// What stands still: names, table, notes.
void draw_still_words(Canvas& canvas, const BesidePlan& plan, const RunSetup& setup, const BesideStyle& style,
                      const BesideWords& words);

// The clock and, in a difference, its shares.
void draw_moving_words(Canvas& canvas, const BesidePlan& plan, const BesideStyle& style, const BesideWords& words,
                       double clock, double only_film, double only_run);

}  // namespace tumble::render
