// The simulator's loops one by one, for each instruction set of this machine, on a packed mill that has turned for a
// while; its balls fit into the second cache. Items are contacts, pairs or balls, as the name says.
//   bench_kernels [--benchmark_filter=balls] [--benchmark_repetitions=5 --benchmark_report_aggregates_only=true]
#include <benchmark/benchmark.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>
#include <vector>

#include "sim/packing.h"
#include "sim/running_mill.h"

using namespace tumble;
using namespace tumble::sim;

namespace {

Config packed_mill() {
  Config c;
  c.mill.diameter = 1.735;
  c.mill.speed = 0.7;
  c.mill.lifters = {.count = 57, .profile = LifterProfile::kRectangle, .height = 0.02, .width = 0.02, .points = {}};
  c.charge.count = 1500;
  c.charge.balls = {{0.012, 0.06, 138}, {0.018, 0.195, 8}, {0.025, 0.525, 2}};
  c.contact.wall.restitution = 0.4;
  c.run.time_step = 1e-4;
  return c;
}

RunningMill turned(const Config& config) {
  const MillModel model = make_mill_model(config);
  RunningMill mill = start_mill(model, settle(model, place_loosely(config, model, draw_balls(config)), {}));
  mill.ledger.counting_impacts = true;
  while (double(mill.step) * model.time_step < 3) advance(mill);
  return mill;
}

// A copy of the turned mill, and what the loops are given of it.
struct Scene {
  explicit Scene(const Kernels& kernels, const RunningMill& like) : mill(like) {
    mill.kernels = &kernels;
    mill.lifters.cos = mill.lifter_cos.data();
    mill.lifters.sin = mill.lifter_sin.data();
    view = view_of(mill);
    const auto room = std::bit_ceil(mill.charge.size() + kMostLanes);
    rows.resize(room * kRow);
    forces = {rows.data(), static_cast<int>(room) - 1};
  }
  ContactStep step(const ContactModel& law) const {
    return {&law,         &view, &mill.exact, mill.model.time_step, {mill.model.shell.radius, mill.model.speed, 0},
            &mill.lifters};
  }
  ContactTable& touching(Kind kind) { return mill.patches[0].touching[static_cast<std::size_t>(kind)]; }
  NearPairs& near(Kind kind) { return mill.patches[0].near[static_cast<std::size_t>(kind)]; }
  int balls() const { return static_cast<int>(mill.charge.size()); }

  RunningMill mill;
  ChargeView view{};
  std::vector<double> rows;
  ForceView forces{};
};

const RunningMill& plain_mill() {
  static const RunningMill mill = turned(packed_mill());
  return mill;
}
const RunningMill& rolling_mill() {
  static const RunningMill mill = [] {
    Config config = packed_mill();
    config.effects["rolling_resistance"]["coefficient"] = {0.02};
    return turned(config);
  }();
  return mill;
}

const RunningMill& worn_mill() {
  static const RunningMill mill = [] {
    Config config = packed_mill();
    config.effects["lifter_wear"] = {{"height_loss", {0.3}}, {"rounding", {0.005}}};
    return turned(config);
  }();
  return mill;
}

void count(benchmark::State& state, int items) { state.SetItemsProcessed(state.iterations() * items); }

template <class Body>  // body(first, last, pushes, sums)
void in_blocks(benchmark::State& state, const ContactTable& table, const Body& body) {
  Pushes out;
  ContactSums sums;
  for ([[maybe_unused]] auto _ : state) {
    for (int k = 0; k < table.size(); k += kBlock) body(k, std::min(k + kBlock, table.size()), out, sums);
    benchmark::DoNotOptimize(sums);
  }
  count(state, table.size());
}

void contacts_of_balls(benchmark::State& state, const Kernels& kernels, const RunningMill& mill) {
  Scene s(kernels, mill);
  const ContactStep step = s.step(s.mill.model.ball);
  const ContactColumns columns = columns_of(s.touching(Kind::kBalls));
  in_blocks(state, s.touching(Kind::kBalls), [&](int first, int last, Pushes& out, ContactSums& sums) {
    kernels.balls(step, columns, first, last, out, sums);
  });
}
void ball_contacts(benchmark::State& state, const Kernels& kernels) { contacts_of_balls(state, kernels, plain_mill()); }
void rolling_ball_contacts(benchmark::State& state, const Kernels& kernels) {
  contacts_of_balls(state, kernels, rolling_mill());
}
void plate_contacts(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, plain_mill());
  const ContactStep step = s.step(s.mill.model.wall);
  const ContactColumns columns = columns_of(s.touching(Kind::kPlate));
  in_blocks(state, s.touching(Kind::kPlate), [&](int first, int last, Pushes& out, ContactSums& sums) {
    kernels.plate(step, columns, first, last, out, sums);
  });
}
void lifter_contacts(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, plain_mill());
  const ContactStep step = s.step(s.mill.model.wall);
  const ContactColumns columns = columns_of(s.touching(Kind::kLifters));
  const WallPoints points{};
  in_blocks(state, s.touching(Kind::kLifters), [&](int first, int last, Pushes& out, ContactSums& sums) {
    kernels.lifters(step, columns, first, last, points, out, sums);
  });
}

void nearest_on_worn_lifters(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, worn_mill());
  const ContactTable& table = s.touching(Kind::kLifters);
  WallPoints points;
  for ([[maybe_unused]] auto _ : state)
    for (int k = 0; k < table.size(); k += kBlock) {
      kernels.nearest_on_runs(s.view, s.mill.runs, table.i.data() + k, table.j.data() + k,
                              std::min(kBlock, table.size() - k), points);
      benchmark::DoNotOptimize(points);
    }
  count(state, table.size());
}

template <class Touching>  // touching(tier, hits)
void in_tiers(benchmark::State& state, const NearPairs& near, const Touching& touching) {
  std::vector<int> hits;
  int pairs = 0;
  for (const NearPairs::Tier& t : near.tiers) {
    hits.resize(std::max(hits.size(), t.i.size() + kMostLanes));
    pairs += t.count;
  }
  for ([[maybe_unused]] auto _ : state)
    for (const NearPairs::Tier& t : near.tiers) benchmark::DoNotOptimize(touching(t, hits.data()));
  count(state, pairs);
}
void touching_pairs(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, plain_mill());
  in_tiers(state, s.near(Kind::kBalls), [&](const NearPairs::Tier& t, int* hits) {
    return kernels.touching_pairs(s.view, t.i.data(), t.j.data(), t.count, hits);
  });
}
void touching_plate(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, plain_mill());
  in_tiers(state, s.near(Kind::kPlate), [&](const NearPairs::Tier& t, int* hits) {
    return kernels.touching_plate(s.view, s.mill.model.shell.radius, t.i.data(), t.count, hits);
  });
}
void touching_lifters(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, plain_mill());
  in_tiers(state, s.near(Kind::kLifters), [&](const NearPairs::Tier& t, int* hits) {
    return kernels.touching_lifters(s.view, s.mill.lifters, t.i.data(), t.j.data(), t.count, hits);
  });
}

// All near pairs of the grid, afresh, into p and q; how many.
int find_near(const Scene& s, const Kernels& kernels, std::vector<int>& p, std::vector<int>& q) {
  const CellGrid& grid = s.mill.grid;
  const GridView view{grid.x(), grid.y(), grid.radius()};
  const double smallest = *std::min_element(s.mill.charge.radius.begin(), s.mill.charge.radius.end());
  int found = 0;
  for (int ball = 0; ball < s.balls(); ++ball)
    grid.for_ranges(
        ball, 2 * view.radius[ball] + s.mill.skin, view.radius[ball] > smallest, [&](int first, int last, bool later) {
          found += kernels.near_of(view, ball, first, last, s.mill.skin, !later, p.data() + found, q.data() + found);
        });
  return found;
}
struct NearBalls : Scene {
  explicit NearBalls(const Kernels& kernels) : Scene(kernels, plain_mill()) {
    const std::vector<double>& radius = mill.charge.radius;
    mill.grid.fill(mill.charge, 2 * std::accumulate(radius.begin(), radius.end(), 0.0) / balls() + mill.skin);
    found = find_near(*this, kernels, p, q);
  }
  static constexpr std::size_t kRoom = 100'000;  // far more pairs than there are
  std::vector<int> p = std::vector<int>(kRoom), q = std::vector<int>(kRoom);
  int found = 0;
};
void near_of_balls(benchmark::State& state, const Kernels& kernels) {
  NearBalls s(kernels);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(find_near(s, kernels, s.p, s.q));
  count(state, s.balls());
}
void gaps_of_pairs(benchmark::State& state, const Kernels& kernels) {
  NearBalls s(kernels);
  const GridView view{s.mill.grid.x(), s.mill.grid.y(), s.mill.grid.radius()};
  std::vector<double> gap(NearBalls::kRoom);
  for ([[maybe_unused]] auto _ : state) {
    kernels.gaps(view, s.p.data(), s.q.data(), s.found, gap.data());
    benchmark::DoNotOptimize(gap.data());
  }
  count(state, s.found);
}

void scatter_contacts(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, plain_mill());
  const ContactTable& table = s.touching(Kind::kBalls);
  const std::vector<double> pushes(static_cast<std::size_t>(kRow * kBlock), 1.0);
  for ([[maybe_unused]] auto _ : state)
    for (int k = 0; k < table.size(); k += kBlock)
      for (const int* at : {table.i.data(), table.j.data()})
        kernels.scatter(pushes.data(), at + k, std::min(kBlock, table.size() - k), s.forces);
  count(state, table.size());
}

void drift_balls(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, plain_mill());
  double time_step = s.mill.model.time_step;
  for ([[maybe_unused]] auto _ : state) {
    kernels.drift(s.view, time_step, 0, s.balls());
    time_step = -time_step;  // so that the balls stay where they are
  }
  count(state, s.balls());
}

void kick_balls(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, plain_mill());
  // No gravity: nothing else pushes, and speeds would grow without end.
  const KickTerms terms{.body = &s.mill.model.body, .time_step = s.mill.model.time_step, .gravity = 0};
  KickSums sums;
  for ([[maybe_unused]] auto _ : state) {
    kernels.kick(s.view, terms, s.mill.exact, s.forces, 0, s.balls(), sums);
    benchmark::DoNotOptimize(sums);
  }
  count(state, s.balls());
}

void whole_step_balls(benchmark::State& state, const Kernels& kernels) {
  Scene s(kernels, plain_mill());
  for ([[maybe_unused]] auto _ : state) advance(s.mill);
  count(state, s.balls());
}

struct Loop {
  const char* name;
  void (*run)(benchmark::State&, const Kernels&);
};
constexpr Loop kLoops[] = {{"balls, contacts", ball_contacts},
                           {"balls with rolling resistance, contacts", rolling_ball_contacts},
                           {"plate, contacts", plate_contacts},
                           {"lifters, contacts", lifter_contacts},
                           {"nearest_on_runs of worn lifters, contacts", nearest_on_worn_lifters},
                           {"scatter, contacts", scatter_contacts},
                           {"touching_pairs, pairs", touching_pairs},
                           {"touching_plate, pairs", touching_plate},
                           {"touching_lifters, pairs", touching_lifters},
                           {"near_of, balls", near_of_balls},
                           {"gaps, pairs", gaps_of_pairs},
                           {"drift, balls", drift_balls},
                           {"kick, balls", kick_balls},
                           {"whole step, balls", whole_step_balls}};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  for (const Loop& loop : kLoops)
    for (const Kernels* kernels : all_kernels())
      benchmark::RegisterBenchmark((std::string(loop.name) + "/" + kernels->name).c_str(),
                                   [run = loop.run, kernels](benchmark::State& state) { run(state, *kernels); });
  benchmark::RunSpecifiedBenchmarks();
}
