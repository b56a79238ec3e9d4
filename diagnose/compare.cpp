#include "diagnose/compare.h"

#include <cmath>

#include "core/angle.h"

namespace tumble::diagnose {
namespace {

struct Quantity {
  const char* name;
  const char* unit;
  Estimate ChargeMotion::*of;
  bool direction;
};

constexpr Quantity kQuantities[] = {
    {"speed_rpm", "rev/min", &ChargeMotion::speed_rpm, false},
    {"speed_fraction", "of critical", &ChargeMotion::speed_fraction, false},
    {"filling", "", &ChargeMotion::filling, false},
    {"toe_deg", "deg", &ChargeMotion::toe_deg, true},
    {"shoulder_deg", "deg", &ChargeMotion::shoulder_deg, true},
    {"toe_bulk_deg", "deg", &ChargeMotion::toe_bulk_deg, true},
    {"shoulder_bulk_deg", "deg", &ChargeMotion::shoulder_bulk_deg, true},
    {"toe_outer_deg", "deg", &ChargeMotion::toe_outer_deg, true},
    {"shoulder_outer_deg", "deg", &ChargeMotion::shoulder_outer_deg, true},
    {"head_m", "m", &ChargeMotion::head, false},
    {"centre_of_circulation_x_m", "m", &ChargeMotion::centre_of_circulation_x, false},
    {"centre_of_circulation_y_m", "m", &ChargeMotion::centre_of_circulation_y, false},
    {"departure_deg", "deg", &ChargeMotion::departure_deg, true},
    {"impact_toe_deg", "deg", &ChargeMotion::impact_toe_deg, true},
    {"torque_N_m", "N m", &ChargeMotion::torque, false},
    {"torque_closure_N_m", "N m", &ChargeMotion::torque_closure, false},
};

}  // namespace

Deviation compare(const ChargeMotion& a, const ChargeMotion& b) {
  Deviation deviation{a.origin, b.origin, {}};
  for (const Quantity& q : kQuantities) {
    Difference d{q.name, q.unit, a.*q.of, b.*q.of};
    if (std::isnan(d.a.value) && std::isnan(d.b.value)) continue;
    d.difference = q.direction ? wrap_180(d.b.value - d.a.value) : d.b.value - d.a.value;
    d.se = std::hypot(d.a.se, d.b.se);
    if (d.se > 0) d.z = d.difference / d.se;
    deviation.differences.push_back(d);
  }
  return deviation;
}

}  // namespace tumble::diagnose
