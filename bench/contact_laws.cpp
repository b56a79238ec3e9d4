#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <mutex>

#include "core/parallel_for.h"
#include "core/random.h"
#include "core/units.h"
#include "diagnose/contact_laws.h"
#include "diagnose/found_laws.h"
#include "io/config_file.h"
#include "sim/simulator.h"

// How well laws are measured at single balls (docs/contact-laws.md): simulated mills seen with the noise of tracking.
//
//   contact_laws MILL.toml SEEDS NOISE_mm [KEY=VALUE ...]            pulls of every bin and of every law's z
//   contact_laws MILL.toml SEEDS NOISE_mm --hidden KEY=VALUE ...     the model does not know the keys after --hidden
namespace tumble {
namespace {

using diagnose::ContactLaws;

constexpr double kSpinNoiseDeg = 0.5;  // of an angle's change from frame to frame

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * kPi * random.uniform());
}

struct Seen {
  std::vector<diagnose::MeasuredLaw> laws;
  diagnose::LawNumbers with_noise, without;
  std::vector<diagnose::FoundLaw> found;
  std::size_t flights = 0, balls = 0, wall = 0;
  double watching = 0, simulating = 0;  // [s]
};

Seen watch(const Config& truth, const Config& model, double noise, std::uint64_t seed) {
  Config config = truth;
  config.run.seed = seed;
  ContactLaws noisy(model), clean(model);
  std::vector<double> radius;
  Random random(seed * 7919);
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& s) { radius = s.balls.radius; };
  double watching = 0, drawing = 0;
  sink.frame = [&](const Frame& f) {
    const double begun = cpu_seconds();
    std::vector<diagnose::Sighting> seen(f.x.size()), exact(f.x.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
      exact[i] = {static_cast<int>(i), f.x[i], f.y[i], radius[i], f.spin[i]};
      seen[i] = {
          static_cast<int>(i), f.x[i] + noise * normal(random), f.y[i] + noise * normal(random), radius[i],
          f.spin[i] + (noise > 0 ? kSpinNoiseDeg * kPi / 180 * config.run.frames_per_second * normal(random) : 0)};
    }
    noisy.add(f.time, f.mill_angle, seen);
    const double before = cpu_seconds();
    clean.add(f.time, f.mill_angle, exact);
    watching += cpu_seconds() - before;
    drawing += before - begun;
  };
  const double start = cpu_seconds();
  sim::simulate(config, sink);
  const double simulating = cpu_seconds() - start - watching - drawing, before_numbers = cpu_seconds();
  Seen s;
  s.without = clean.numbers();
  s.watching = watching + cpu_seconds() - before_numbers;
  s.simulating = simulating;
  s.laws = noisy.laws();
  s.with_noise = noisy.numbers();
  const diagnose::SeenExperiment watched{&noisy.events(), &model};
  s.found = diagnose::found_laws(std::span(&watched, 1));
  s.flights = noisy.events().flights().size();
  for (const diagnose::SeenImpact& e : noisy.events().impacts()) ++(e.at_wall ? s.wall : s.balls);
  return s;
}

struct Spread {
  double sum = 0, squares = 0, n = 0;
  void add(double v) {
    if (!std::isfinite(v)) return;
    sum += v;
    squares += v * v;
    n += 1;
  }
  double mean() const { return sum / n; }
  double sd() const { return n > 1 ? std::sqrt((squares - sum * sum / n) / (n - 1)) : NAN; }
};

void run(const Config& truth, const Config& model, int seeds, double noise) {
  std::vector<Seen> all(static_cast<std::size_t>(seeds));
  parallel_for(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) all[k] = watch(truth, model, noise, 101 + k);
  });
  Spread flights, balls, wall;
  for (const Seen& s : all) flights.add(double(s.flights)), balls.add(double(s.balls)), wall.add(double(s.wall));
  fmt::print("{} runs: {:.0f} flights, {:.0f} impacts of balls, {:.0f} at the wall in each\n", seeds, flights.mean(),
             balls.mean(), wall.mean());
  double watching = 0, simulating = 0;
  for (const Seen& s : all) watching += s.watching, simulating += s.simulating;
  fmt::print("watching takes {:.1f} % of the time of simulating\n", 100 * watching / simulating);
  for (std::size_t l = 0; l < all[0].laws.size(); ++l) {
    Spread z;
    for (const Seen& s : all) z.add(s.laws[l].z);
    fmt::print("{:<30} z {:6.2f} +- {:.2f} of {:.0f}\n", all[0].laws[l].name, z.mean(), z.sd(), z.n);
    const diagnose::MeasuredLaw& law = all[0].laws[l];
    for (std::size_t p = 0; p < law.parameters.size(); ++p) {
      Spread value, se, pull;
      for (const Seen& s : all) {
        if (p >= s.laws[l].parameters.size()) continue;
        const diagnose::LawParameter& q = s.laws[l].parameters[p];
        value.add(q.value);
        se.add(q.se);
        pull.add((q.value - q.model) / q.se);
      }
      fmt::print("    {:<14} {:9.4f} +- {:.4f} (says {:.4f}) {}, model {:.4f}, pull {:6.2f} sd {:.2f}\n",
                 law.parameters[p].name, value.mean(), value.sd(), se.mean(), law.parameters[p].unit,
                 law.parameters[p].model, pull.mean(), pull.sd());
    }
    fmt::print("    {}\n", law.says);
  }
  fmt::print("numbers: value, scatter, said error; with less without noise, over the scatter of that\n");
  for (std::size_t i = 0; i < diagnose::kLawNumbers; ++i) {
    Spread v, se, bias;
    for (const Seen& s : all) {
      v.add(s.with_noise.value[i]);
      se.add(s.with_noise.se[i]);
      bias.add(s.with_noise.value[i] - s.without.value[i]);
    }
    fmt::print("    {:<32} {:9.4f} +- {:.4f} (says {:.4f})  noise moves it {:8.4f} +- {:.4f}\n",
               diagnose::name_of_law_number(i), v.mean(), v.sd(), se.mean(), bias.mean(),
               bias.sd() / std::sqrt(bias.n));
  }
  // Of each bin against the model.
  for (std::size_t l = 0; l < all[0].laws.size(); ++l)
    for (std::size_t b = 0; b < 4; ++b) {
      Spread pull, x, y, own, count;
      for (const Seen& s : all) {
        if (b >= s.laws[l].x.size()) continue;
        pull.add((s.laws[l].y[b] - s.laws[l].model[b]) / s.laws[l].se[b]);
        x.add(s.laws[l].x[b]);
        y.add(s.laws[l].y[b]);
        own.add(s.laws[l].model[b]);
        count.add(s.laws[l].count[b]);
      }
      if (pull.n > 0)
        fmt::print("{:<30} bin {} x {:8.3f}  y {:8.4f} model {:8.4f}  of {:5.0f}  pull {:6.2f} sd {:.2f} ({} runs)\n",
                   all[0].laws[l].name, b, x.mean(), y.mean(), own.mean(), count.mean(), pull.mean(), pull.sd(),
                   pull.n);
    }
  for (const Seen& s : all)
    for (const diagnose::FoundLaw& f : s.found) {
      fmt::print("found {}: {} {:.4g} +- {:.2g} {} (in {:.2f}, p {:.1e})\n", f.of, f.term, f.coefficient, f.se, f.unit,
                 f.inclusion, f.f_test_p);
      for (const std::string& set : f.sets) fmt::print("    {}\n", set);
    }
}

}  // namespace
}  // namespace tumble

int main(int argc, char** argv) try {
  using namespace tumble;
  if (argc < 4) {
    std::fputs("contact_laws MILL.toml SEEDS NOISE_mm [KEY=VALUE ...] [--hidden KEY=VALUE ...]\n", stderr);
    return 2;
  }
  std::vector<std::string> known{"run.frames_per_second=250"}, hidden;
  bool hide = false;
  for (int k = 4; k < argc; ++k)
    if (std::string(argv[k]) == "--hidden")
      hide = true;
    else
      (hide ? hidden : known).push_back(argv[k]);
  const Config model = io::read_config(argv[1], known);
  run(io::with_sets(model, hidden), model, std::stoi(argv[2]), std::stod(argv[3]) / 1000);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "contact_laws: %s\n", e.what());
  return 1;
}
