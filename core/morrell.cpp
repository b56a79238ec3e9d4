#include "core/morrell.h"

#include <cmath>

#include "core/angle.h"
#include "core/statistics.h"

namespace tumble {

ToeAndShoulder morrell_toe_and_shoulder(double filling, double speed_fraction) {
  const double centrifuging = 0.35 * (3.364 - filling);
  if (!(speed_fraction < centrifuging)) return {kNotGiven, kNotGiven};
  const double lag = 2.5307 * (1.2796 - filling) * (1 - std::exp(-19.42 * (centrifuging - speed_fraction)));
  const double lift = (0.3386 + 0.1041 * speed_fraction) + (1.54 - 2.5673 * speed_fraction) * filling;
  return {degrees(kPi / 2 + lag), wrap_360(degrees(kPi / 2 - lag * lift))};
}

}  // namespace tumble
