#include "render/outline_table.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::render {
namespace {

using Point = Eigen::Vector2d;
struct Piece {
  Point from, to;
};

double distance_to(const Piece& piece, const Point& p) {
  const Point way = piece.to - piece.from;
  const double along = std::clamp((p - piece.from).dot(way) / std::max(way.squaredNorm(), 1e-18), 0.0, 1.0);
  return (p - piece.from - along * way).norm();
}

// Where the ray from the axis in this direction crosses the piece: its distance from the axis, or -1.
double crossing(const Piece& piece, const Point& direction) {
  const Point side(-direction.y(), direction.x());
  const double a = piece.from.dot(side), b = piece.to.dot(side);
  if ((a < 0) == (b < 0)) return -1;
  const double share = a / (a - b);
  return (piece.from + share * (piece.to - piece.from)).dot(direction);
}

}  // namespace

OutlineTable make_outline_table(const MillShape& shape) {
  OutlineTable table;
  table.tip = shape.tip_radius / shape.radius;
  if (shape.sections.empty()) return table;
  // Columns a multiple of the lifters, so that equal lifters have equal columns.
  const int per_pitch = std::max(64, 2048 / shape.lifter_count);
  table.columns = per_pitch * shape.lifter_count;
  table.rows = 160;
  table.begin = table.tip - 0.12;
  table.end = 1.06;

  std::vector<Piece> pieces;
  const auto line = outline(shape, 0.02 * shape.radius);
  for (std::size_t i = 0; i < line.size(); ++i)
    pieces.push_back({line[i] / shape.radius, line[(i + 1) % line.size()] / shape.radius});

  table.distance.resize(static_cast<std::size_t>(table.columns) * table.rows);
  const bool all_alike =
      std::all_of(shape.section_of.begin(), shape.section_of.end(), [](int section) { return section == 0; });
  const int worked_out = all_alike ? per_pitch : table.columns;
  std::vector<Piece> near;
  std::vector<double> crossings;
  for (int column = 0; column < table.columns; ++column) {
    if (column >= worked_out) {
      for (int row = 0; row < table.rows; ++row)
        table.distance[static_cast<std::size_t>(row) * table.columns + column] =
            table.distance[static_cast<std::size_t>(row) * table.columns + column % per_pitch];
      continue;
    }
    const double angle = 2 * kPi * (column + 0.5) / table.columns;
    const Point direction(std::cos(angle), std::sin(angle));
    near.clear();
    crossings.clear();
    for (const Piece& piece : pieces) {
      if (piece.from.dot(direction) < 0.9 * piece.from.norm()) continue;  // what lies farther off is never the nearest
      near.push_back(piece);
      if (const double at = crossing(piece, direction); at > 0) crossings.push_back(at);
    }
    for (int row = 0; row < table.rows; ++row) {
      const double rho = table.begin + (table.end - table.begin) * (row + 0.5) / table.rows;
      double least = 1;
      for (const Piece& piece : near) least = std::min(least, distance_to(piece, rho * direction));
      const auto beyond = std::count_if(crossings.begin(), crossings.end(), [rho](double at) { return at > rho; });
      table.distance[static_cast<std::size_t>(row) * table.columns + column] =
          static_cast<float>(beyond % 2 == 1 ? least : -least);
    }
  }
  return table;
}

}  // namespace tumble::render
