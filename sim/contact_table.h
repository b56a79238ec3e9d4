#pragma once
#include <array>
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

// The pairs that touched at the last step, a structure of arrays with room for whole batches of lanes. Their order
// means nothing.
struct ContactTable {
  int count = 0;
  std::vector<int> i, j;
  std::vector<double> damping, overlap, dashpot, spring, normal_lost, sliding_lost;
  std::vector<double> force, stored, term_damping, roll;  // of a model that is not plain, else empty
  std::vector<std::uint16_t> place;                       // at the wall, else empty

  int size() const { return count; }
};

void add(ContactTable& table, const Contact& contact, Kind kind, bool plain);
void set(ContactTable& table, int k, const Contact& contact);
void remove(ContactTable& table, int k);
Contact contact_at(const ContactTable& table, int k);
ContactColumns columns_of(ContactTable& table);

}  // namespace tumble::sim
