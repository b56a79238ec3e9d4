#include "core/frame.h"

#include <algorithm>

namespace tumble {

Frame between(const Frame& a, const Frame& b, double time) {
  const double h = b.time - a.time;
  const double u = h > 0 ? std::clamp((time - a.time) / h, 0.0, 1.0) : 0.0;
  if (u == 0) return a;
  if (u == 1) return b;
  const double p0 = (1 + 2 * u) * (1 - u) * (1 - u), p1 = u * u * (3 - 2 * u);
  const double m0 = u * (1 - u) * (1 - u) * h, m1 = u * u * (u - 1) * h;
  const double d0 = 6 * u * (u - 1) / h, d1 = -d0, e0 = (1 - u) * (1 - 3 * u), e1 = u * (3 * u - 2);

  Frame f = u < 0.5 ? a : b;
  f.time = time;
  f.mill_angle = a.mill_angle + u * (b.mill_angle - a.mill_angle);
  const auto blend = [&](std::vector<double>& x, std::vector<double>& v, auto position, auto velocity) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = p0 * (a.*position)[i] + m0 * (a.*velocity)[i] + p1 * (b.*position)[i] + m1 * (b.*velocity)[i];
      v[i] = d0 * (a.*position)[i] + e0 * (a.*velocity)[i] + d1 * (b.*position)[i] + e1 * (b.*velocity)[i];
    }
  };
  blend(f.x, f.vx, &Frame::x, &Frame::vx);
  blend(f.y, f.vy, &Frame::y, &Frame::vy);
  blend(f.angle, f.spin, &Frame::angle, &Frame::spin);
  return f;
}

}  // namespace tumble
