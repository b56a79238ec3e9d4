#pragma once
#include <string>

#include "core/charge_motion.h"
#include "core/mill_shape.h"

namespace tumble::io::report {

// The mill as inline SVG: shell and lifters, the time-mean occupancy as shades, mean velocity as arrows, toe, shoulder
// and centre of circulation of `motion`, and `other`'s toe and shoulder as thin lines (nullptr: none). Colours are
// the page's classes. `label` is what a screen reader says.
std::string mill_picture(const MillShape& shape, const ChargeMotion& motion, const ChargeMotion* other,
                         const std::string& label);

}  // namespace tumble::io::report
