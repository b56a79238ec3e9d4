#pragma once

namespace tumble {

// Where Morrell has the charge's toe and shoulder, as ChargeMotion has its own [degrees, counter-clockwise from
// 3 o'clock]; NaN where he has the whole charge centrifuge.
struct ToeAndShoulder {
  double toe_deg, shoulder_deg;
};

// S. Morrell, "Power draw of wet tumbling mills and its relationship to charge dynamics", parts 1 and 2, Trans. Inst.
// Min. Metall. C 105 (1996) C43-C62, with angles in radians:
//
//     phi_c   = max(phi, 0.35 (3.364 - J))
//     theta_T = 2.5307 (1.2796 - J) (1 - exp(-19.42 (phi_c - phi))) + pi/2
//     theta_S = pi/2 - (theta_T - pi/2) ((0.3386 + 0.1041 phi) + (1.54 - 2.5673 phi) J)
//
// `filling` J: share of the mill's volume that the charge takes, its voids included, (0, 1); `speed_fraction` phi: of
// critical speed, > 0. Fitted to wet mills with lifters as industry has them; a few tall lifters carry a charge higher.
ToeAndShoulder morrell_toe_and_shoulder(double filling, double speed_fraction);

}  // namespace tumble
