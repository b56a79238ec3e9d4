#pragma once
#include "core/effects.h"

// Cohesion: while two bodies touch they attract each other with a force that does not depend on the overlap,
//
//   F_n -> F_n - F_c R / R_mean       R = r_i r_j / (r_i + r_j), at the wall r; R_mean of two mean balls [m]
//
// so the force needed to pull them apart is F_c for two mean balls and grows with R, as for a liquid bridge (2 pi gamma
// R cos) and in the DMT limit of adhesion (Derjaguin, Muller & Toporov 1975). The bond ends where the overlap does: no
// bridge is stretched, and by itself it takes no energy. The contact is pressed together by F_n + F_c, which is what
// friction is limited by.
namespace tumble::sim {

struct Cohesion {
  double per_radius = 0;  // F_c / R_mean [N/m]
};

// `mean_radius`: number mean of the balls [m].
inline Cohesion make_cohesion(const Config& config, double mean_radius) {
  return {effect_value(config, "cohesion", "force") / (mean_radius / 2)};
}

}  // namespace tumble::sim
