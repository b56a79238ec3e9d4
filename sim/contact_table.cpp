#include "sim/contact_table.h"

#include <algorithm>

namespace tumble::sim {
namespace {

// No more than asked for: vectors by themselves double.
template <class Column>
void widen(Column& column, std::size_t room) {
  column.reserve(room);
  column.resize(room);
}

std::size_t place_of(const ContactTable& t, int k) {
  return static_cast<std::size_t>(k / kGroup * kGroup * t.columns + k % kGroup);
}

}  // namespace

void add(ContactTable& t, const Contact& contact, Kind kind, bool plain) {
  if (t.size() == static_cast<int>(t.i.size())) {
    const std::size_t room = t.i.size() + std::max<std::size_t>(1, t.i.size() / kBlock / 8) * kBlock;
    t.columns = plain ? kPlainColumns : kAllColumns;
    widen(t.i, room);
    widen(t.j, room);
    widen(t.numbers, room * static_cast<std::size_t>(t.columns));
    if (kind != Kind::kBalls) widen(t.place, room);
  }
  set(t, t.count++, contact);
}

void set(ContactTable& t, int at, const Contact& c) {
  const auto k = static_cast<std::size_t>(at);
  t.i[k] = c.i;
  t.j[k] = c.j;
  double* number = t.numbers.data() + place_of(t, at);
  number[kGroup * kDamping] = c.damping;
  number[kGroup * kOverlap] = c.state.overlap;
  number[kGroup * kDashpot] = c.state.dashpot;
  number[kGroup * kSpring] = c.state.spring;
  number[kGroup * kNormalLost] = c.state.normal_lost;
  number[kGroup * kSlidingLost] = c.state.sliding_lost;
  if (t.columns == kAllColumns) {
    number[kGroup * kForce] = c.terms.force;
    number[kGroup * kStored] = c.terms.stored;
    number[kGroup * kTermDamping] = c.terms.damping;
    number[kGroup * kRoll] = c.terms.roll;
  }
  if (!t.place.empty()) t.place[k] = c.place;
}

void remove(ContactTable& table, int k) {
  --table.count;
  set(table, k, contact_at(table, table.count));
}

Contact contact_at(const ContactTable& t, int at) {
  const auto k = static_cast<std::size_t>(at);
  const double* number = t.numbers.data() + place_of(t, at);
  Contact c;
  c.i = t.i[k];
  c.j = t.j[k];
  c.damping = number[kGroup * kDamping];
  c.state = {number[kGroup * kOverlap], number[kGroup * kDashpot], number[kGroup * kSpring],
             number[kGroup * kNormalLost], number[kGroup * kSlidingLost]};
  if (t.columns == kAllColumns)
    c.terms = {number[kGroup * kForce], number[kGroup * kStored], number[kGroup * kTermDamping],
               number[kGroup * kRoll]};
  if (!t.place.empty()) c.place = t.place[k];
  return c;
}

ContactColumns columns_of(ContactTable& t) { return {t.i.data(), t.j.data(), t.numbers.data(), t.columns}; }

}  // namespace tumble::sim
