#include "core/contact_force.h"

#include <algorithm>
#include <cmath>

namespace tumble {

std::vector<double> largest_forces(std::span<const ContactForce> contacts, std::size_t balls) {
  std::vector<double> largest(balls, 0.0);
  const auto raise = [&](int ball, double force) {
    double& now = largest[static_cast<std::size_t>(ball)];
    now = std::max(now, std::abs(force));
  };
  for (const ContactForce& c : contacts) {
    raise(c.i, c.normal);
    if (c.j >= 0) raise(c.j, c.normal);
  }
  return largest;
}

}  // namespace tumble
