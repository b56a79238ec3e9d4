// Random mills, each run for 0.2 s and watched: tests/fuzz with as many mills as there is patience for. A failure is
// shrunk and its MILL.toml printed; `--mill FILE` runs one again.
//   fuzz_mills 1000 --seed 1
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>

#include "tests/fuzz/fuzz_run.h"

using namespace tumble;
using namespace tumble::fuzz;

namespace {

double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

void print_percentiles(const char* name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  fmt::print("{:<40}", name);
  for (const double share : {0.5, 0.9, 0.99, 1.0})
    fmt::print(" {:>10.2e}", values[static_cast<std::size_t>(share * double(values.size() - 1))]);
  fmt::print("\n");
}

std::string one_line(const Outcome& o) {
  return fmt::format("{} {}energy {:.1e}, momentum {:.1e}, most negative loss {:.1e}, deepest {:.2f} wall {:.2f} ball",
                     o.kind.empty() ? "fine" : o.kind, o.what.empty() ? "" : "(" + o.what + ") ", o.energy_error,
                     o.momentum_error, o.worst_loss, o.deepest_wall, o.deepest_ball);
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Random mills, watched"};
  int number = 100;
  std::uint64_t seed = 1;
  double most_ball_steps = 2e6;
  bool keep_whole = false, list = false;
  std::filesystem::path one;
  std::string start = "settled";
  app.add_option("number", number, "Mills to run");
  app.add_option("--seed", seed, "Of the random mills");
  app.add_option("--ball-steps", most_ball_steps, "Balls x steps that a mill may cost");
  app.add_flag("--whole", keep_whole, "Do not shrink failures");
  app.add_flag("--list", list, "Print a line for each mill");
  app.add_option("--mill", one, "Run this MILL.toml instead");
  app.add_option("--start", start, "Of --mill")->check(CLI::IsMember({"settled", "loose", "thrown"}));
  CLI11_PARSE(app, argc, argv);

  if (!one.empty()) {
    Case c{io::read_config(one)};
    c.start = static_cast<Start>(std::find(std::begin(kStartNames), std::end(kStartNames), start) - kStartNames);
    check_complete(c.config);
    const Outcome o = run(c);
    fmt::print("# {}\n", one_line(o));
    if (!keep_whole && !o.kind.empty()) fmt::print("{}", io::to_toml(shrunk(c, o.kind).config));
    return o.kind.empty() ? 0 : 1;
  }

  Random random(seed);
  Tally tally;
  std::map<std::string, int> failures;
  std::vector<double> energy, momentum, gain, wall, ball, cost, balls;
  for (int k = 0; k < number; ++k) {
    const Case c = random_mill(random, most_ball_steps, tally);
    const double began = cpu_seconds();
    const Outcome o = run(c);
    cost.push_back(cpu_seconds() - began);
    if (list) {
      fmt::print("{} {:.2f} s {}\n", k, cost.back(), one_line(o));
      std::fflush(stdout);
    }
    if (o.kind.empty()) {
      energy.push_back(o.energy_error);
      momentum.push_back(o.momentum_error);
      gain.push_back(-o.worst_loss);
      wall.push_back(o.deepest_wall);
      ball.push_back(o.deepest_ball);
      balls.push_back(double(sim::draw_balls(c.config).size()));
      continue;
    }
    ++failures[o.kind];
    const Case simple = keep_whole || o.kind == "no_room" ? c : shrunk(c, o.kind);
    fmt::print("# mill {} of seed {}, --start {}: {}\n# now: {}\n{}\n", k, seed, kStartNames[int(c.start)], one_line(o),
               one_line(run(simple)), io::to_toml(simple.config));
    std::fflush(stdout);
  }
  fmt::print("{} mills of seed {}: {} drawn, {} not valid, {} too dear; {:.0f} s of CPU\n", number, seed, tally.drawn,
             tally.not_valid, tally.too_dear, cpu_seconds());
  for (const auto& [kind, count] : failures) fmt::print("failed, {}: {}\n", kind, count);
  if (energy.empty()) return 1;
  fmt::print("{:<40} {:>10} {:>10} {:>10} {:>10}\n", "of those without failure", "50 %", "90 %", "99 %", "most");
  print_percentiles("energy missing, of what flowed", energy);
  print_percentiles("angular momentum missing", momentum);
  print_percentiles("loss that is a gain, of what flowed", gain);
  print_percentiles("overlap with the wall, radii", wall);
  print_percentiles("overlap of balls, radii", ball);
  print_percentiles("CPU, s", cost);
  print_percentiles("balls", balls);
  return failures.empty() ? 0 : 1;
} catch (const Error& e) {
  fmt::print(stderr, "fuzz_mills: {}\n", e.what());
  return 2;
}
