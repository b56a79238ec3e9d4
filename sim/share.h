#pragma once
#include <tbb/cache_aligned_allocator.h>

#include <array>
#include <vector>

#include "sim/contact_table.h"
#include "sim/near_pairs.h"

// How the work of a step is cut up. It changes no bit of what is simulated: sums are exact.
namespace tumble::sim {

// Balls that are stored side by side, and the contacts found from them: few enough to stay in the cache while a step
// drifts them, works out their contacts and kicks them.
struct Patch {
  int first = 0, last = 0;  // balls
  std::array<NearPairs, kKinds> near;
  std::array<ContactTable, kKinds> touching;
  int low = 0, high = 0;              // balls that its contacts can reach
  int low_patch = 0, high_patch = 0;  // patches that they lie in, both included
  int done_before = 0;  // once it is done, no contact of its thread that is still to come reaches an earlier patch
  bool apart = true;    // no contact of another thread reaches its balls
};

// A contact that began, or that has ended and what was lost in it. `j` is -1 at the wall.
struct Begun {
  int i = 0, j = 0;
};
struct Ended {
  int i = 0, j = 0, feature = 0;
  std::uint16_t place = 0;
  double normal_lost = 0, sliding_lost = 0;  // [J]
};

// One thread's patches. Each thread sums up forces for itself.
struct Share {
  int first = 0, last = 0;       // patches
  int low = 0, high = 0;         // balls that their contacts can reach
  double work = 0, seconds = 0;  // of a step, as estimated; taken by its thread since the last search [s]
  double pace = 1;               // work a second, as a share of the threads' mean
  // Rows, see ForceView: as many as there are balls between the last that waits for its kick and the first that has not
  // been reached, so that they stay in the cache.
  std::vector<double, tbb::cache_aligned_allocator<double>> forces;
  int mask = 0;

  // Of the last step.
  ContactSums at_balls, at_wall;
  KickSums kick;
  std::vector<Begun> begun;
  std::vector<Ended> ended;

  // Work space.
  std::vector<int> hits, parted, found_p, found_q;
  std::vector<double> gaps;
  std::vector<Contact> sorted;
  std::vector<int> start;
};

}  // namespace tumble::sim
