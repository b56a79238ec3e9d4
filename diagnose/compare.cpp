#include "diagnose/compare.h"

#include <cmath>

#include "core/angle.h"
#include "core/motion_quantities.h"

namespace tumble::diagnose {

Deviation compare(const ChargeMotion& a, const ChargeMotion& b) {
  Deviation deviation{a.origin, b.origin, {}};
  for (const MotionQuantity& q : kMotionQuantities) {
    Difference d{q.name, q.unit_in_words, a.*q.of, b.*q.of};
    if (std::isnan(d.a.value) && std::isnan(d.b.value)) continue;
    d.difference = q.is_direction ? wrap_180(d.b.value - d.a.value) : d.b.value - d.a.value;
    d.se = std::hypot(d.a.se, d.b.se);
    if (d.se > 0) d.z = d.difference / d.se;
    deviation.differences.push_back(d);
  }
  return deviation;
}

}  // namespace tumble::diagnose
