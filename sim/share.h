#pragma once
#include <array>
#include <vector>

#include "sim/contact_table.h"
#include "sim/near_pairs.h"

namespace tumble::sim {

// A contact that began, or that has ended and what was lost in it. `j` is -1 at the wall.
struct Begun {
  int i = 0, j = 0;
};
struct Ended {
  int i = 0, j = 0, feature = 0;
  std::uint16_t place = 0;
  double normal_lost = 0, sliding_lost = 0;  // [J]
};

// One thread's part of the balls and of the contacts. Contacts belong to where they were found, and their forces are
// summed up by each share for itself, on the window of balls that its contacts reach; sums are exact, so that it does
// not matter how the work is shared.
struct Share {
  int first = 0, last = 0;  // balls
  std::array<NearPairs, kKinds> near;
  std::array<ContactTable, kKinds> touching;

  int window = 0, window_size = 0;  // balls that the forces below belong to
  std::vector<double> forces;       // rows, with room for whole batches of lanes

  // Of the last step.
  ContactSums at_balls, at_wall;
  KickSums kick;
  std::vector<Begun> begun;
  std::vector<Ended> ended;

  // Work space.
  std::vector<int> hits, parted, found_p, found_q;
  std::vector<double> gaps;
};

}  // namespace tumble::sim
