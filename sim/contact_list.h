#pragma once
#include <cstdint>
#include <vector>

#include "sim/cell_grid.h"
#include "sim/mill_model.h"

namespace tumble::sim {

// Two bodies that may touch before the list is next renewed: ball i and ball j > i, or ball i and feature j of the
// shell.
struct Contact {
  int i = 0, j = 0;
  double reach = 0;    // sum of the radii; the ball's radius at the wall [m]
  double damping = 0;  // C of this pair [N s/m]
};

// Near pairs in ascending order of (i, j), with the memory of those that touch. The order makes every sum over contacts
// the same whatever was found near, so renewing early or late changes no bit.
struct ContactList {
  std::vector<Contact> contacts;
  std::vector<std::uint8_t> touching;  // at the last step
  std::vector<ContactState> states;
  std::vector<TermState> terms;      // of a model that is not plain, else empty
  std::vector<std::uint16_t> place;  // of the first touch, face x kAngleBins + angle bin; contacts with the wall only

  std::size_t size() const { return contacts.size(); }
};

// What the renewals need besides; kept so that nothing is allocated once the sizes have settled.
struct ContactSearch {
  CellGrid grid;
  ContactList next;
  std::vector<int> found;
};

// Finds all pairs nearer than touching + skin; contacts that touched keep their memory.
void renew_ball_contacts(const MillModel& model, const Charge& charge, double skin, ContactSearch& search,
                         ContactList& list);
void renew_wall_contacts(const MillModel& model, const Charge& charge, double mill_angle, double skin,
                         ContactSearch& search, ContactList& list);

}  // namespace tumble::sim
