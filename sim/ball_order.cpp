#include "sim/ball_order.h"

#include <algorithm>

namespace tumble::sim {
namespace {

template <class Column>
void reorder(Column& column, const std::vector<int>& order, Column& space) {
  if (column.empty()) return;
  space.resize(column.size());
  for (std::size_t p = 0; p < order.size(); ++p) space[p] = column[static_cast<std::size_t>(order[p])];
  std::swap(column, space);
}

// The ball at `order[p]` comes to p.
void move_balls(RunningMill& mill, const std::vector<int>& order) {
  Charge& c = mill.charge;
  std::vector<double> space;
  std::vector<int> int_space;
  for (auto* column : moving_columns(c)) reorder(*column, order, space);
  for (auto* column : constant_columns(c)) reorder(*column, order, space);
  reorder(mill.flights.apex, order, space);
  reorder(mill.flights.contacts, order, int_space);
  reorder(c.id, order, int_space);

  std::vector<int> place(order.size());
  for (std::size_t p = 0; p < order.size(); ++p) place[static_cast<std::size_t>(order[p])] = static_cast<int>(p);
  for (Share& share : mill.shares)
    for (int kind = 0; kind < kKinds; ++kind) {
      ContactTable& table = share.touching[static_cast<std::size_t>(kind)];
      for (int k = 0; k < table.size(); ++k) {
        int& i = table.i[static_cast<std::size_t>(k)];
        i = place[static_cast<std::size_t>(i)];
        if (kind != static_cast<int>(Kind::kBalls)) continue;
        int& j = table.j[static_cast<std::size_t>(k)];
        j = place[static_cast<std::size_t>(j)];
      }
    }
  mill.stale = true;
}

// All contacts of a kind by their ball i, as many to each share.
void deal_out(RunningMill& mill, Kind kind) {
  const auto of_kind = static_cast<std::size_t>(kind);
  std::vector<int> start(mill.charge.size() + 1, 0);
  int count = 0;
  for (const Share& share : mill.shares) {
    const ContactTable& table = share.touching[of_kind];
    for (int k = 0; k < table.size(); ++k) ++start[static_cast<std::size_t>(table.i[static_cast<std::size_t>(k)]) + 1];
    count += table.size();
  }
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<Contact> contacts(static_cast<std::size_t>(count));
  for (Share& share : mill.shares) {
    ContactTable& table = share.touching[of_kind];
    for (int k = 0; k < table.size(); ++k) {
      const Contact c = contact_at(table, k);
      contacts[static_cast<std::size_t>(start[static_cast<std::size_t>(c.i)]++)] = c;
    }
    table.count = 0;
  }
  const std::size_t shares = mill.shares.size();
  for (std::size_t s = 0; s < shares; ++s)
    for (std::size_t k = contacts.size() * s / shares; k < contacts.size() * (s + 1) / shares; ++k)
      add(mill.shares[s].touching[of_kind], contacts[k], kind, mill.model.plain());
}

}  // namespace

void sort_by_cell(RunningMill& mill) {
  move_balls(mill, mill.grid.balls());
  for (const Kind kind : {Kind::kBalls, Kind::kPlate, Kind::kLifters}) deal_out(mill, kind);
  mill.grid.number_afresh();
}

void sort_by_number(RunningMill& mill) {
  std::vector<int> order(mill.charge.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[static_cast<std::size_t>(mill.charge.id[i])] = static_cast<int>(i);
  if (!std::is_sorted(order.begin(), order.end())) move_balls(mill, order);
}

}  // namespace tumble::sim
