#pragma once
#include <utility>
#include <vector>

#include "analysis/tracking.h"

namespace tumble::analysis {

struct Path {
  int size_class = 0;
  double radius = 0;
  std::vector<std::pair<int, int>> seen;  // frame, index in it
};

// What balls did at a place, on a coarse grid over the mill: mean displacement per frame and its spread.
class FlowGuess {
 public:
  explicit FlowGuess(const std::vector<SeenFrame>& frames);
  void add(double x, double y, double vx, double vy);

  struct Motion {
    bool known = false;
    double vx = 0, vy = 0, spread = 0;  // [length/frame]
  };
  Motion at(double x, double y) const;

 private:
  struct Cell {
    double n = 0, vx = 0, vy = 0, squares = 0;
  };
  std::size_t index(double x, double y) const;
  double half_ = 1;
  std::vector<Cell> cells_;
};

FlowGuess flow_of(const std::vector<SeenFrame>& frames, const std::vector<Path>& paths);

// Typical change of a ball's colour from one sighting to the next [grey levels], from paths linked without it.
double colour_noise(const std::vector<SeenFrame>& frames, const std::vector<Path>& paths);

// Frame by frame, each at least total cost. `flow` and `colour_noise`: null and NaN on the first go. Fills confidence.
std::vector<Path> link_frames(std::vector<SeenFrame>& frames, const MotionModel& model, const FlowGuess* flow,
                              double colour_noise);

// Joins ends of paths to later beginnings across gaps of up to model.longest_gap frames, all at once and at least
// total cost.
std::vector<Path> join_paths(std::vector<Path> paths, std::vector<SeenFrame>& frames, const MotionModel& model,
                             const FlowGuess& flow, double colour_noise);

// Square of the difference of two colours over the noise, at most 9; 0 where the noise is NaN.
double colour_cost(const Sighting& a, const Sighting& b, double noise);

}  // namespace tumble::analysis
