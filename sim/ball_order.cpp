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
  std::vector<std::vector<double>*> columns{&mill.flights.apex};
  for (auto* column : moving_columns(c))
    if (mill.model.body.ends.on() || (column != &c.end_x && column != &c.end_y)) columns.push_back(column);
  for (auto* column : constant_columns(c)) columns.push_back(column);
  const auto reorder_some = [&](std::size_t begin, std::size_t end) {
    std::vector<double> space;
    for (std::size_t k = begin; k < end; ++k) reorder(*columns[k], order, space);
  };
  if (mill.shares.size() == 1)
    reorder_some(0, columns.size());
  else
    parallel_for(columns.size(), 1, reorder_some);
  std::vector<int> int_space;
  reorder(mill.flights.contacts, order, int_space);
  reorder(c.id, order, int_space);

  std::vector<int> place(order.size());
  for (std::size_t p = 0; p < order.size(); ++p) place[static_cast<std::size_t>(order[p])] = static_cast<int>(p);
  for_patches(mill, [&](Patch& patch, Share&) {
    for (int kind = 0; kind < kKinds; ++kind) {
      ContactTable& table = patch.touching[static_cast<std::size_t>(kind)];
      for (int k = 0; k < table.size(); ++k) {
        int& i = table.i[static_cast<std::size_t>(k)];
        i = place[static_cast<std::size_t>(i)];
        if (kind != static_cast<int>(Kind::kBalls)) continue;
        int& j = table.j[static_cast<std::size_t>(k)];
        j = place[static_cast<std::size_t>(j)];
      }
    }
  });
  mill.stale = true;
}

// Every contact to the patch of its ball i.
void deal_out(RunningMill& mill, Kind kind) {
  const auto of_kind = static_cast<std::size_t>(kind);
  for (std::size_t p = 0; p < mill.patches.size(); ++p) {
    ContactTable& table = mill.patches[p].touching[of_kind];
    for (int k = table.size() - 1; k >= 0; --k) {
      std::size_t home = p;
      const int i = table.i[static_cast<std::size_t>(k)];
      while (i < mill.patches[home].first) --home;
      while (i >= mill.patches[home].last) ++home;
      if (home == p) continue;
      add(mill.patches[home].touching[of_kind], contact_at(table, k), kind, mill.model.plain());
      remove(table, k);
    }
  }
}

// The contacts of a patch by their ball i.
void sort_contacts(const Patch& patch, ContactTable& table, Share& space) {
  std::vector<int>& start = space.start;
  start.assign(static_cast<std::size_t>(patch.last - patch.first + 1), 0);
  const auto of = [&](int k) { return static_cast<std::size_t>(table.i[static_cast<std::size_t>(k)] - patch.first); };
  for (int k = 0; k < table.size(); ++k) ++start[of(k) + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  space.sorted.resize(static_cast<std::size_t>(table.size()));
  for (int k = 0; k < table.size(); ++k) space.sorted[static_cast<std::size_t>(start[of(k)]++)] = contact_at(table, k);
  for (int k = 0; k < table.size(); ++k) set(table, k, space.sorted[static_cast<std::size_t>(k)]);
}

}  // namespace

void sort_by_cell(RunningMill& mill) {
  move_balls(mill, mill.grid.balls());
  for (const Kind kind : {Kind::kBalls, Kind::kPlate, Kind::kLifters}) deal_out(mill, kind);
  for_patches(mill, [&](Patch& patch, Share& share) {
    for (ContactTable& table : patch.touching) sort_contacts(patch, table, share);
  });
  mill.grid.number_afresh();
}

void sort_by_number(RunningMill& mill) {
  std::vector<int> order(mill.charge.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[static_cast<std::size_t>(mill.charge.id[i])] = static_cast<int>(i);
  if (!std::is_sorted(order.begin(), order.end())) move_balls(mill, order);
}

}  // namespace tumble::sim
