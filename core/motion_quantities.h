#pragma once
#include <array>
#include <string>

#include "core/charge_motion.h"

// The quantities of a charge motion that are one number with an error: one row serves MOTION.h5, summary.json and the
// comparison of two motions.
namespace tumble {

struct MotionQuantity {
  const char* name;           // as in summary.json
  const char* words;          // as a reader has it, before a number
  const char* unit;           // as in files: UDUNITS, "" for a pure number
  const char* unit_in_words;  // the same for a reader
  Estimate ChargeMotion::*of;
  bool is_direction = false;  // in degrees: differences are taken round the circle
};

inline constexpr std::array kMotionQuantities{
    MotionQuantity{"speed_rpm", "Speed", "min-1", "rev/min", &ChargeMotion::speed_rpm},
    MotionQuantity{"speed_fraction", "Speed, share of critical", "", "of critical", &ChargeMotion::speed_fraction},
    MotionQuantity{"filling", "Filling", "", "", &ChargeMotion::filling},
    MotionQuantity{"toe_deg", "Toe", "deg", "deg", &ChargeMotion::toe_deg, true},
    MotionQuantity{"shoulder_deg", "Shoulder", "deg", "deg", &ChargeMotion::shoulder_deg, true},
    MotionQuantity{"toe_bulk_deg", "Toe, bulk", "deg", "deg", &ChargeMotion::toe_bulk_deg, true},
    MotionQuantity{"shoulder_bulk_deg", "Shoulder, bulk", "deg", "deg", &ChargeMotion::shoulder_bulk_deg, true},
    MotionQuantity{"toe_outer_deg", "Toe, outer", "deg", "deg", &ChargeMotion::toe_outer_deg, true},
    MotionQuantity{"shoulder_outer_deg", "Shoulder, outer", "deg", "deg", &ChargeMotion::shoulder_outer_deg, true},
    MotionQuantity{"head_m", "Head of the charge", "m", "m", &ChargeMotion::head},
    MotionQuantity{"centre_of_circulation_x_m", "Centre of circulation, x", "m", "m",
                   &ChargeMotion::centre_of_circulation_x},
    MotionQuantity{"centre_of_circulation_y_m", "Centre of circulation, y", "m", "m",
                   &ChargeMotion::centre_of_circulation_y},
    MotionQuantity{"departure_deg", "Departure from the shell", "deg", "deg", &ChargeMotion::departure_deg, true},
    MotionQuantity{"impact_toe_deg", "Impact toe", "deg", "deg", &ChargeMotion::impact_toe_deg, true},
    MotionQuantity{"surface_angle_deg", "Surface of the charge, angle of repose", "deg", "deg",
                   &ChargeMotion::surface_angle_deg, true},
    MotionQuantity{"flight_share", "In flight", "", "of the balls", &ChargeMotion::flight_share},
    MotionQuantity{"circulation_time_s", "Time of a turn about the centre of circulation", "s", "s",
                   &ChargeMotion::circulation_time},
    MotionQuantity{"granular_temperature_m2_s2", "Granular temperature of the charge", "m2 s-2", "m2/s2",
                   &ChargeMotion::granular_temperature},
    MotionQuantity{"torque_N_m", "Torque of one slice", "N m", "N m", &ChargeMotion::torque},
    MotionQuantity{"torque_closure_N_m", "Torque by the charge’s weight", "N m", "N m", &ChargeMotion::torque_closure},
};

// What people call a quantity of summary.json; its name where it is none.
inline std::string words_for(const std::string& name) {
  for (const MotionQuantity& q : kMotionQuantities)
    if (name == q.name) return q.words;
  return name;
}

}  // namespace tumble
