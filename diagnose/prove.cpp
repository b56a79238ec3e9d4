#include "diagnose/prove.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/fingerprint.h"
#include "core/quantile.h"
#include "diagnose/in_turns.h"
#include "diagnose/observe.h"

namespace tumble::diagnose {
namespace {

constexpr double kMostlyThere = 0.8;  // of the runs must show a number
constexpr int kMostRetreats = 8;

double mean_of(const std::vector<std::vector<double>>& seen, std::size_t i) {
  double sum = 0;
  for (const auto& s : seen) sum += s[i];
  return sum / double(seen.size());
}

double strength_at(const Scene& scene, const Model& model, std::size_t suspect) {
  return model.places[static_cast<Eigen::Index>(scene.middle.size() + suspect)];
}

// The error of measurement that the model knows of, all artefacts taken together.
Observer observer_of(const Scene& scene, const Model& model) {
  Observer sum;
  for (std::size_t s = 0; s < scene.suspects.size(); ++s) {
    const Observer& o = scene.suspects[s].observer;
    const double strength = strength_at(scene, model, s);
    sum.scale += strength * o.scale;
    sum.rotation += strength * o.rotation;
    sum.clock += strength * o.clock;
  }
  return sum;
}

Observer opposite(const Observer& o) { return {1 / (1 + o.scale) - 1, -o.rotation, 1 / (1 + o.clock) - 1}; }

}  // namespace

std::vector<std::string> sets_of(const Scene& scene, const std::vector<UncertainKey>& uncertain, const Model& model) {
  std::vector<std::string> sets;
  for (std::size_t k = 0; k < uncertain.size(); ++k)
    sets.push_back(fmt::format("{}={}", uncertain[k].key,
                               scene.middle[k] + model.places[static_cast<Eigen::Index>(k)] * uncertain[k].sd));
  for (std::size_t s = 0; s < scene.suspects.size(); ++s) {
    const double strength = strength_at(scene, model, s);
    if (strength == 0 || !scene.suspects[s].is_simulated()) continue;
    for (std::string& set : sets_at(scene.suspects[s], strength)) sets.push_back(std::move(set));
  }
  return sets;
}

void make_possible(Model& model, const std::vector<Scene>& scenes, const std::vector<UncertainKey>& uncertain,
                   const MillWith& mill_with) {
  for (int retreat = 0;; ++retreat) try {
      for (const Scene& scene : scenes) mill_with(scene.measurement->config, sets_of(scene, uncertain, model));
      return;
    } catch (const InputError&) {
      if (retreat == kMostRetreats) throw;
      model.places.head(static_cast<Eigen::Index>(uncertain.size())) *= kRetreat;
    }
}

std::vector<double> corrected(const Scene& scene, const Model& model, std::vector<double>& noise) {
  const ObservationLayout layout(scene.measurement->config.mill.lifters.count);
  double offset = 0;
  for (std::size_t s = 0; s < scene.suspects.size(); ++s)
    offset += strength_at(scene, model, s) * scene.suspects[s].torque_offset * scene.torque_unit;
  Observation seen = observe(*scene.measurement, layout, scene.span, opposite(observer_of(scene, model)), offset);
  noise = std::move(seen.noise);
  return turned_on(layout, seen.value, model.lifter);
}

std::vector<Replicas> resimulate(const std::vector<Scene>& scenes, const std::vector<UncertainKey>& uncertain,
                                 const Model& model, std::size_t seeds, const MillWith& mill_with,
                                 const Progress& progress) {
  std::vector<SignatureRun> all(scenes.size() * seeds);
  in_turns(all.size(), progress, [&](std::size_t i, const Progress& own) {
    const Scene& scene = scenes[i / seeds];
    const std::vector<std::string> sets = sets_of(scene, uncertain, model);
    Config config = mill_with(scene.measurement->config, sets);
    config.run.seed = fingerprint(fmt::format("{} {}", fmt::join(sets, " "), i));
    all[i] = run_signature(config, scene.measurement->config, own, Watched::kRight);
  });
  std::vector<Replicas> by_scene(scenes.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    Replicas& replicas = by_scene[i / seeds];
    if (!all[i].error.empty()) continue;
    replicas.seen.push_back(observed_at(all[i].seen, scenes[i / seeds].span));
    replicas.revolutions += (all[i].revolutions - replicas.revolutions) / double(replicas.seen.size());
  }
  return by_scene;
}

Chance chance_of(const std::vector<const Replicas*>& sets) {
  std::vector<double> squares;
  double freedom = 0;
  const auto each_run = [&](const auto& use) {  // with its distance from the mean of its set, had it no part in that
    for (const Replicas* set : sets) {
      const double n = double(set->seen.size());
      if (n < 2) continue;
      std::vector<double> apart(set->seen.front().size());
      for (const auto& run : set->seen) {
        for (std::size_t i = 0; i < apart.size(); ++i)
          apart[i] = (run[i] - mean_of(set->seen, i)) * std::sqrt(n / (n - 1));
        use(apart, (n - 1) / n);
      }
    }
  };
  each_run([&](const std::vector<double>& apart, double share) {
    squares.resize(apart.size(), 0);
    for (std::size_t i = 0; i < apart.size(); ++i) squares[i] += share * apart[i] * apart[i];
    freedom += share;
  });
  Chance chance;
  each_run([&](const std::vector<double>& apart, double) {
    std::vector<double>& z = chance.left_out.emplace_back();
    for (std::size_t i = 0; i < apart.size(); ++i)
      z.push_back(apart[i] / std::sqrt((squares[i] - apart[i] * apart[i]) / (freedom - 1)));
  });
  for (const double s : squares) chance.scatter.push_back(std::sqrt(s / freedom));
  return chance;
}

double chance_limit(const Chance& chance, std::size_t first, std::size_t count) {
  std::vector<double> largest;
  for (const std::vector<double>& z : chance.left_out) {
    double most = 0;
    for (std::size_t i = first; i < first + count; ++i)
      if (std::isfinite(z[i])) most = std::max(most, std::abs(z[i]));
    largest.push_back(most);
  }
  return quantile_of(std::move(largest), 0.95);
}

Contrast contrast(const Scene& scene, const Model& model, const Replicas& runs, const Chance& chance) {
  Contrast c;
  if (runs.seen.empty()) return c;
  std::vector<double> noise;
  const std::vector<double> measured = corrected(scene, model, noise);
  const double watched = scene.measurement->revolutions > 0 ? scene.measurement->revolutions : runs.revolutions;
  const double n = double(runs.seen.size());
  double sum = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double mean = mean_of(runs.seen, i);
    double there = 0;
    for (const auto& s : runs.seen) there += std::abs(s[i]) > 1e-12;
    if (std::isnan(measured[i]) || std::isnan(mean) || there < kMostlyThere * n) continue;
    const double variance = chance.scatter[i] * chance.scatter[i] * (runs.revolutions / watched + 1 / n);
    const double z = (measured[i] - mean) / std::sqrt(variance + noise[i] * noise[i]);
    if (!std::isfinite(z)) continue;
    c.numbers.push_back(i);
    c.measured.push_back(measured[i]);
    c.simulated.push_back(mean);
    c.z.push_back(z);
    sum += z * z;
  }
  std::vector<double> by_chance;  // of each run left out; in some a ball is wedged that moves freely in the others
  for (const std::vector<double>& run : chance.left_out) {
    double squares = 0, known = 0;
    for (const std::size_t i : c.numbers)
      if (std::isfinite(run[i])) squares += run[i] * run[i], ++known;
    by_chance.push_back(squares / known);
  }
  c.chi = std::sqrt(sum / double(c.numbers.size()) / quantile_of(std::move(by_chance), 0.5));
  return c;
}

}  // namespace tumble::diagnose
