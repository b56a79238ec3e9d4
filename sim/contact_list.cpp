#include "sim/contact_list.h"

#include <algorithm>

namespace tumble::sim {
namespace {

void clear(ContactList& list) {
  list.contacts.clear();
  list.touching.clear();
  list.states.clear();
  list.terms.clear();
  list.place.clear();
}

// Memory for the contacts found; all zero.
void add_memory(ContactList& list, bool plain, bool at_wall) {
  list.touching.resize(list.contacts.size());
  list.states.resize(list.contacts.size());
  if (!plain) list.terms.resize(list.contacts.size());
  if (at_wall) list.place.resize(list.contacts.size());
}

// Both lists are sorted: one walk hands the memory on.
void carry_over(const ContactList& from, ContactList& to) {
  const auto before = [](const Contact& a, const Contact& b) { return a.i < b.i || (a.i == b.i && a.j < b.j); };
  std::size_t t = 0;
  for (std::size_t f = 0; f < from.size(); ++f) {
    if (!from.touching[f]) continue;
    while (t < to.size() && before(to.contacts[t], from.contacts[f])) ++t;
    if (t == to.size()) return;
    if (before(from.contacts[f], to.contacts[t])) continue;
    to.touching[t] = 1;
    to.states[t] = from.states[f];
    if (!to.terms.empty()) to.terms[t] = from.terms[f];
    if (!to.place.empty()) to.place[t] = from.place[f];
  }
}

}  // namespace

void renew_ball_contacts(const MillModel& model, const Charge& charge, double skin, ContactSearch& search,
                         ContactList& list) {
  ContactList& next = search.next;
  clear(next);
  const Damping damping(model.ball.springs, model.time_step);
  search.grid.fill(charge, 2 * *std::max_element(charge.radius.begin(), charge.radius.end()) + skin);
  for (int i = 0; i < static_cast<int>(charge.size()); ++i) {
    search.grid.partners_of(charge, i, skin, search.found);
    for (const int j : search.found) {
      const double effective_mass = charge.mass[i] * charge.mass[j] / (charge.mass[i] + charge.mass[j]);
      next.contacts.push_back({i, j, charge.radius[i] + charge.radius[j], damping.of(effective_mass)});
    }
  }
  add_memory(next, model.plain(), false);
  carry_over(list, next);
  std::swap(list, next);
}

void renew_wall_contacts(const MillModel& model, const Charge& charge, double mill_angle, double skin,
                         ContactSearch& search, ContactList& list) {
  ContactList& next = search.next;
  clear(next);
  const Damping damping(model.wall.springs, model.time_step);
  for (int i = 0; i < static_cast<int>(charge.size()); ++i) {
    search.found.clear();
    features_near(model.shell, mill_angle, charge.x[i], charge.y[i], charge.radius[i] + skin, search.found);
    for (const int feature : search.found)
      next.contacts.push_back({i, feature, charge.radius[i], damping.of(charge.mass[i])});
  }
  add_memory(next, model.plain(), true);
  carry_over(list, next);
  std::swap(list, next);
}

}  // namespace tumble::sim
