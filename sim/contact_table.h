#pragma once
#include <tbb/cache_aligned_allocator.h>

#include <cstdint>
#include <vector>

#include "sim/kernels/kernels.h"

namespace tumble::sim {

// What a pair meets: its lists and loops are kept apart by this.
enum class Kind { kBalls, kPlate, kLifters };
inline constexpr int kKinds = 3;

// A contact and what it remembers.
struct Contact {
  int i = 0, j = 0;    // ball and ball, or ball and feature of the shell
  double damping = 0;  // C of this pair [N s/m]
  ContactState state;
  TermState terms;          // of a model that is not plain
  std::uint16_t place = 0;  // at the wall: of the first touch, face x kAngleBins + angle bin
};

// The pairs that touched at the last step, with room for whole batches of lanes. Their order means nothing. See
// ContactColumns for how the numbers lie.
struct ContactTable {
  int count = 0;
  std::vector<int> i, j;
  std::vector<double, tbb::cache_aligned_allocator<double>> numbers;
  std::vector<std::uint16_t> place;  // at the wall, else empty
  int columns = kPlainColumns;

  int size() const { return count; }
};

void add(ContactTable& table, const Contact& contact, Kind kind, bool plain);
void set(ContactTable& table, int k, const Contact& contact);
void remove(ContactTable& table, int k);
Contact contact_at(const ContactTable& table, int k);
ContactColumns columns_of(ContactTable& table);

}  // namespace tumble::sim
