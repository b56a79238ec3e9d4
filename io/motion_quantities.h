#pragma once
#include <array>

#include "core/charge_motion.h"

// The quantities of a charge motion that are one number with an error: one row serves MOTION.h5 and summary.json.
namespace tumble::io {

struct Quantity {
  const char* name;  // as in summary.json
  const char* unit;
  Estimate ChargeMotion::*of;
};

inline constexpr std::array kQuantities{
    Quantity{"speed_rpm", "min-1", &ChargeMotion::speed_rpm},
    Quantity{"speed_fraction", "", &ChargeMotion::speed_fraction},
    Quantity{"filling", "", &ChargeMotion::filling},
    Quantity{"toe_deg", "deg", &ChargeMotion::toe_deg},
    Quantity{"shoulder_deg", "deg", &ChargeMotion::shoulder_deg},
    Quantity{"toe_bulk_deg", "deg", &ChargeMotion::toe_bulk_deg},
    Quantity{"shoulder_bulk_deg", "deg", &ChargeMotion::shoulder_bulk_deg},
    Quantity{"toe_outer_deg", "deg", &ChargeMotion::toe_outer_deg},
    Quantity{"shoulder_outer_deg", "deg", &ChargeMotion::shoulder_outer_deg},
    Quantity{"head_m", "m", &ChargeMotion::head},
    Quantity{"centre_of_circulation_x_m", "m", &ChargeMotion::centre_of_circulation_x},
    Quantity{"centre_of_circulation_y_m", "m", &ChargeMotion::centre_of_circulation_y},
    Quantity{"departure_deg", "deg", &ChargeMotion::departure_deg},
    Quantity{"impact_toe_deg", "deg", &ChargeMotion::impact_toe_deg},
    Quantity{"torque_N_m", "N m", &ChargeMotion::torque},
    Quantity{"torque_closure_N_m", "N m", &ChargeMotion::torque_closure},
};

inline const char* name_of(Rotation rotation) {
  switch (rotation) {
    case Rotation::kCounterClockwise:
      return "counter_clockwise";
    case Rotation::kClockwise:
      return "clockwise";
    case Rotation::kUnknown:
      break;
  }
  return "unknown";
}

inline const char* name_of(MotionSource source) {
  switch (source) {
    case MotionSource::kRunFile:
      return "run_file";
    case MotionSource::kFilm:
      return "film";
    case MotionSource::kStills:
      break;
  }
  return "stills";
}

}  // namespace tumble::io
