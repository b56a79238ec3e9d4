#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

namespace tumble::render {

// A field at the middles of n x n square cells about the mill's axis, row by row from the lowest y, as core's Field
// has it; NaN where nothing is known.
struct Grid {
  int n = 0;
  double cell = 0;  // edge [m]
  std::vector<double> value;
  double& at(int i, int j) { return value[static_cast<std::size_t>(j) * n + i]; }
  double at(int i, int j) const { return value[static_cast<std::size_t>(j) * n + i]; }
  double place(int i) const { return (i - (n - 1) / 2.0) * cell; }  // of a column or row [m]
};

struct Contour {
  std::vector<Eigen::Vector2d> points;  // [m]; the last joins the first again where it is closed
  bool closed = false;
};

// Where the field, linear between the cells' middles, crosses the level (marching squares). What is higher lies to the
// left of a line's direction. Lines end at the unknown.
std::vector<Contour> contours(const Grid& grid, double level);

// The corners cut off twice (Chaikin 1974): a line through cells looks like what it stands for. Points that lie within
// `tolerance` of the line without them are left out [m].
Contour rounded(const Contour& line, double tolerance);

// Mean of each known value and its eight neighbours, 1-2-1 in both directions.
Grid smoothed(const Grid& grid);

}  // namespace tumble::render
