#pragma once
#include <span>
#include <vector>

namespace tumble {

// What presses at one contact at one moment.
struct ContactForce {
  int i = 0, j = -1;    // the balls, i < j; j = -1: the shell or a lifter
  double x = 0, y = 0;  // where they touch [m]
  double normal = 0;    // F_n [N], > 0 pushes apart
};

// The largest normal force on each of so many balls [N]; 0 for a ball that touches nothing.
std::vector<double> largest_forces(std::span<const ContactForce> contacts, std::size_t balls);

}  // namespace tumble
