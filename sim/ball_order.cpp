#include "sim/ball_order.h"

#include <algorithm>
#include <utility>

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

// All contacts of a kind by their ball i, as many to each share. In place: contacts are the most of a mill's memory,
// and few lie far from where they belong.
void deal_out(RunningMill& mill, Kind kind) {
  const auto of_kind = static_cast<std::size_t>(kind);
  const auto table_of = [&](std::size_t share) -> ContactTable& { return mill.shares[share].touching[of_kind]; };
  std::vector<int> start(mill.charge.size() + 1, 0);
  std::size_t count = 0;
  for (std::size_t s = 0; s < mill.shares.size(); ++s) {
    const ContactTable& table = table_of(s);
    for (int k = 0; k < table.size(); ++k) ++start[static_cast<std::size_t>(table.i[static_cast<std::size_t>(k)]) + 1];
    count += static_cast<std::size_t>(table.size());
  }
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];

  // Slots count through the tables, each as long as it is or is to be; `to` says where a slot's contact belongs.
  struct Part {
    std::size_t slots, dealt;  // the first of this share
  };
  std::vector<Part> parts;
  std::size_t slots = 0;
  for (std::size_t s = 0; s < mill.shares.size(); ++s) {
    parts.push_back({slots, count * s / mill.shares.size()});
    const std::size_t own = count * (s + 1) / mill.shares.size() - parts.back().dealt;
    slots += std::max(own, static_cast<std::size_t>(table_of(s).size()));
  }
  constexpr int kNowhere = -1;
  std::vector<int> to(slots, kNowhere);
  for (std::size_t s = 0; s < parts.size(); ++s) {
    const ContactTable& table = table_of(s);
    for (int k = 0; k < table.size(); ++k) {
      const auto dealt =
          static_cast<std::size_t>(start[static_cast<std::size_t>(table.i[static_cast<std::size_t>(k)])]++);
      std::size_t home = parts.size() - 1;
      while (parts[home].dealt > dealt) --home;
      to[parts[s].slots + static_cast<std::size_t>(k)] =
          static_cast<int>(parts[home].slots + (dealt - parts[home].dealt));
    }
  }
  const auto last = [&](std::size_t s) { return s + 1 < parts.size() ? parts[s + 1].slots : slots; };
  for (std::size_t s = 0; s < parts.size(); ++s)
    while (static_cast<std::size_t>(table_of(s).size()) < last(s) - parts[s].slots)
      add(table_of(s), Contact{}, kind, mill.model.plain());

  struct At {
    ContactTable& table;
    int k;
  };
  const auto at = [&](std::size_t slot) {
    std::size_t s = parts.size() - 1;
    while (parts[s].slots > slot) --s;
    return At{table_of(s), static_cast<int>(slot - parts[s].slots)};
  };
  for (std::size_t slot = 0; slot < slots; ++slot)
    while (to[slot] != kNowhere && to[slot] != static_cast<int>(slot)) {
      const auto home = static_cast<std::size_t>(to[slot]);
      const At here = at(slot), there = at(home);
      const Contact contact = contact_at(here.table, here.k);
      if (to[home] != kNowhere) set(here.table, here.k, contact_at(there.table, there.k));
      set(there.table, there.k, contact);
      to[slot] = std::exchange(to[home], static_cast<int>(home));
    }
  for (std::size_t s = 0; s < parts.size(); ++s)
    table_of(s).count = static_cast<int>((s + 1 < parts.size() ? parts[s + 1].dealt : count) - parts[s].dealt);
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
