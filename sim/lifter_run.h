#pragma once
#include <algorithm>

// The straight pieces of the lifters' outlines, as plain numbers: what the one-by-one search of sim/shell.cpp and the
// lanes of sim/kernels look at alike.
namespace tumble::sim {

// A straight piece of a lifter's outline in the lifter's own frame (x along the radius through its foot's middle).
template <class Real>
struct BasicFace {
  Real x = 0, y = 0;    // where the face starts; the run goes from the leading to the trailing side [m]
  Real tx = 0, ty = 0;  // unit vector along it
  Real nx = 0, ny = 0;  // unit normal, out of the lifter
  Real length = 0;      // [m]
  Real number = 0;      // of the face in the shell
};
using LifterFace = BasicFace<double>;

// What is wanted of a face once it is known to be the nearest; kept apart, so that the search reads a cache line a
// face.
struct FaceCorners {
  double sx = 0, sy = 0;  // out of the lifter at the corner where it starts (sum of both normals), not normalised
  double ex = 0, ey = 0;  // and where it ends
};

// Faces that lie close together, with a circle around them: most are passed over at once.
struct FaceBlock {
  int begin = 0, end = 0;
  double x = 0, y = 0, reach = 0;  // centre and radius [m]
};

struct Run {
  int begin = 0, end = 0;               // its faces
  int first_block = 0, last_block = 0;  // blocks of them, [first, last)
  int section = 0;
  bool convex = false;             // round a convex body: the quick way
  double x = 0, y = 0, reach = 0;  // circle around the run: centre, radius [m]
};

// How far (x, y) stands out from the line of a face.
template <class Number, class Real>
inline Real out_of(const BasicFace<Number>& f, const Real& x, const Real& y) {
  return (x - f.x) * f.nx + (y - f.y) * f.ny;
}

// Nearest point of a face to (x, y), how far along, and the square of its distance.
template <class Real>
struct Foot {
  Real along, dx, dy, d2;
};
template <class Number, class Real>
inline Foot<Real> foot_on(const BasicFace<Number>& f, const Real& x, const Real& y) {
  using std::max;
  using std::min;
  const Real along = min(max((x - f.x) * f.tx + (y - f.y) * f.ty, Real(0)), Real(f.length));
  const Real dx = f.x + along * f.tx - x, dy = f.y + along * f.ty - y;
  return {along, dx, dy, dx * dx + dy * dy};
}

}  // namespace tumble::sim
