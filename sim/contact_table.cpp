#include "sim/contact_table.h"

#include <algorithm>

namespace tumble::sim {
namespace {

constexpr std::array kPlainColumns{&ContactTable::damping, &ContactTable::overlap,     &ContactTable::dashpot,
                                   &ContactTable::spring,  &ContactTable::normal_lost, &ContactTable::sliding_lost};
constexpr std::array kTermColumns{&ContactTable::force, &ContactTable::stored, &ContactTable::term_damping,
                                  &ContactTable::roll};

template <class Visit>
void for_columns(ContactTable& table, bool terms, bool place, const Visit& visit) {
  visit(table.i);
  visit(table.j);
  for (const auto column : kPlainColumns) visit(table.*column);
  if (terms)
    for (const auto column : kTermColumns) visit(table.*column);
  if (place) visit(table.place);
}

}  // namespace

void add(ContactTable& table, const Contact& contact, Kind kind, bool plain) {
  if (table.size() == static_cast<int>(table.i.size())) {
    const std::size_t room = table.i.size() + std::max<std::size_t>(1, table.i.size() / kBlock / 2) * kBlock;
    for_columns(table, !plain, kind != Kind::kBalls, [&](auto& column) { column.resize(room); });
  }
  set(table, table.count++, contact);
}

void set(ContactTable& t, int at, const Contact& c) {
  const auto k = static_cast<std::size_t>(at);
  t.i[k] = c.i;
  t.j[k] = c.j;
  t.damping[k] = c.damping;
  t.overlap[k] = c.state.overlap;
  t.dashpot[k] = c.state.dashpot;
  t.spring[k] = c.state.spring;
  t.normal_lost[k] = c.state.normal_lost;
  t.sliding_lost[k] = c.state.sliding_lost;
  if (!t.force.empty()) {
    t.force[k] = c.terms.force;
    t.stored[k] = c.terms.stored;
    t.term_damping[k] = c.terms.damping;
    t.roll[k] = c.terms.roll;
  }
  if (!t.place.empty()) t.place[k] = c.place;
}

void remove(ContactTable& table, int k) {
  --table.count;
  set(table, k, contact_at(table, table.count));
}

Contact contact_at(const ContactTable& t, int at) {
  const auto k = static_cast<std::size_t>(at);
  Contact c{t.i[k],       t.j[k],
            t.damping[k], {t.overlap[k], t.dashpot[k], t.spring[k], t.normal_lost[k], t.sliding_lost[k]},
            {},           0};
  if (!t.force.empty()) c.terms = {t.force[k], t.stored[k], t.term_damping[k], t.roll[k]};
  if (!t.place.empty()) c.place = t.place[k];
  return c;
}

ContactColumns columns_of(ContactTable& t) {
  const auto term = [](std::vector<double>& column) { return column.empty() ? nullptr : column.data(); };
  return {t.i.data(),      t.j.data(),           t.overlap.data(),      t.dashpot.data(),
          t.spring.data(), t.normal_lost.data(), t.sliding_lost.data(), t.damping.data(),
          term(t.force),   term(t.stored),       term(t.term_damping),  term(t.roll)};
}

}  // namespace tumble::sim
