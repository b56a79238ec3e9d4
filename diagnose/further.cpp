#include "diagnose/further.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/mill_shape.h"
#include "diagnose/next_experiment.h"
#include "diagnose/ruling.h"

namespace tumble::diagnose {
namespace {

constexpr std::size_t kMostRivals = 4;
constexpr double kCredible = 0.95;
constexpr std::size_t kRuns = 3;                             // of each rival at each other speed and filling
constexpr std::array kSpeeds{0.5, 0.6, 0.7, 0.8, 0.9, 1.0};  // of critical
constexpr std::array kFillings{0.2, 0.3, 0.4, 0.5};
constexpr double kOtherSpeed = 0.04, kOtherFilling = 0.04;  // nearer to what was measured it is no other
constexpr double kLonger = 4;

std::vector<Rival> rivals_of(const Posterior& p, std::span<const Suspect> suspects) {
  std::vector<Rival> rivals;
  double sum = p.unknown;
  for (const Accusation& a : p.accusations) {
    if (rivals.size() == kMostRivals || (sum > kCredible && rivals.size() > 1)) break;
    sum += a.probability;
    const std::string name = a.explanation.suspects.empty() ? "none" : joined(names_of(a, suspects));
    const auto at = std::find_if(rivals.begin(), rivals.end(), [&](const Rival& r) { return r.name == name; });
    if (at == rivals.end())
      rivals.push_back({name, a.explanation, a.probability});
    else
      at->probability += a.probability;
  }
  return rivals;
}

struct Kind {
  const char* measure;
  std::set<Observable> numbers;
  double cost;
};

std::vector<FurtherData> kinds_that_are_missing(const std::vector<Condition>& conditions,
                                                const std::vector<Fitted>& fitted, const std::vector<Scene>& scenes,
                                                std::vector<Fitted>& keep) {
  bool torque = true, frames = true, angles = true, spins = true;
  for (const Fitted& f : fitted) {
    const ObservationLayout layout(scenes[f.scene].measurement->config.mill.lifters.count);
    const auto& seen = f.by_lifter.front();
    const auto told = [&](Observable o) { return !std::isnan(seen[layout.first(o)]); };
    torque = torque && told(Observable::kTorque);
    frames = frames && told(Observable::kOccupancy);
    angles = angles && told(Observable::kAngles);
    spins = spins && told(Observable::kSpin);
  }
  std::vector<Kind> kinds;
  std::set<Observable> film{Observable::kAngles,    Observable::kOccupancy, Observable::kMomentum,
                            Observable::kAgitation, Observable::kPockets,   Observable::kFlight};
  if (torque) film.insert(Observable::kClosure);
  std::set<Observable> marked = film;
  marked.insert({Observable::kSpin, Observable::kLaws});
  if (!torque) kinds.push_back({"measure the torque", {Observable::kTorque, Observable::kClosure}, 1});
  if (!angles && !frames)
    kinds.push_back({"read toe and shoulder off a film or a photograph", {Observable::kAngles}, 1});
  if (!frames) kinds.push_back({"film the mill through a transparent end, at 200 frames/s or more", film, 2});
  if (!spins) kinds.push_back({"film balls with marks that show their spin", marked, 3});
  std::vector<FurtherData> list;
  const auto add = [&](const char* measure, const std::set<Observable>& numbers, double longer, double cost) {
    FurtherData d{measure, {}, cost};
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      keep.push_back(fit(conditions[i], scenes[fitted[i].scene], fitted[i].scene, numbers));
      const Response& r = *keep.back().response;
      d.measured.push_back({&r, Eigen::VectorXd::Zero(r.features().count()), longer * r.revolutions()});
    }
    list.push_back(std::move(d));
  };
  for (const Kind& k : kinds) add(k.measure, k.numbers, 1, k.cost);
  add("watch each of the experiments four times as long", {}, kLonger, kLonger);
  return list;
}

struct Elsewhere {
  std::vector<std::pair<std::string, double>> set;
  std::string measure;
  std::size_t near = 0;  // of the fitted
  Measurement measurement;
};

std::vector<Elsewhere> elsewhere(const std::vector<Fitted>& fitted, const Bench& bench) {
  std::vector<Elsewhere> list;
  const auto config_of = [&](std::size_t f) -> const Config& {
    return (*bench.scenes)[fitted[f].scene].measurement->config;
  };
  const auto filling = [](const Config& c) { return filling_of(c, class_counts(c)); };
  const auto consider = [&](const std::string& what, double value, auto&& now, double other, auto&& set_of) {
    std::size_t near = 0;
    double least = INFINITY;
    for (std::size_t f = 0; f < fitted.size(); ++f)
      if (const double d = std::abs(now(config_of(f)) - value); d < least) least = d, near = f;
    if (least < other) return;
    Elsewhere e{{set_of(config_of(near), value)}, what, near, {}};
    try {
      e.measurement.config =
          (*bench.mill_with)(config_of(near), {fmt::format("{}={}", e.set[0].first, e.set[0].second)});
      e.measurement.experiment.name = what;
      list.push_back(std::move(e));
    } catch (const InputError&) {  // no such mill: too full, say
    }
  };
  for (const double v : kSpeeds)
    consider(
        fmt::format("the same at {} of critical speed", v), v, [](const Config& c) { return speed_fraction(c.mill); },
        kOtherSpeed,
        [](const Config& c, double value) {
          const bool by_share = !std::isnan(c.mill.speed);
          return std::pair<std::string, double>(by_share ? "mill.speed" : "mill.speed_rpm",
                                                by_share ? value : c.mill.speed_rpm * value / speed_fraction(c.mill));
        });
  for (const double v : kFillings)
    consider(fmt::format("the same with a filling of {}", v), v, filling, kOtherFilling,
             [&](const Config& c, double value) {
               if (!c.charge.count) return std::pair<std::string, double>("charge.filling", value);
               return std::pair<std::string, double>("charge.count", std::round(*c.charge.count * value / filling(c)));
             });
  return list;
}

}  // namespace

std::vector<NextExperiment> what_next(const Posterior& posterior, const std::vector<Condition>& conditions,
                                      const std::vector<Fitted>& fitted, const Bench& bench, const Progress& progress) {
  const std::vector<Scene>& scenes = *bench.scenes;
  const std::vector<Suspect>& suspects = scenes.front().suspects;
  const auto keys = static_cast<Eigen::Index>(bench.uncertain->size());
  const std::vector<Rival> rivals = rivals_of(posterior, suspects);
  if (rivals.size() < 2) return {};
  std::vector<Fitted> keep;
  const std::vector<FurtherData> data = kinds_that_are_missing(conditions, fitted, scenes, keep);

  const std::vector<Elsewhere> places = elsewhere(fitted, bench);
  std::vector<Scene> there;
  std::vector<FurtherCondition> list;
  for (const Elsewhere& e : places) {
    const Scene& near = scenes[fitted[e.near].scene];
    there.push_back({&e.measurement, suspects_of(e.measurement.config), near.middle, near.span, near.torque_unit});
    list.push_back({e.set, e.measure, fitted[e.near].response.get(), {}, double(kRuns), 1});
  }
  for (std::size_t r = 0; r < rivals.size() && !places.empty(); ++r) {
    Model model{rivals[r].explanation.places, 0};
    Eigen::VectorXd rightly = model.places;  // as one who does not err sees it
    for (std::size_t s = 0; s < suspects.size(); ++s)
      if (!suspects[s].is_simulated()) rightly[keys + static_cast<Eigen::Index>(s)] = 0;
    const auto runs = resimulate(there, *bench.uncertain, model, kRuns, *bench.mill_with,
                                 [&](double done) { report(progress, (double(r) + done) / double(rivals.size())); });
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Response& response = *list[i].near;
      Eigen::VectorXd seen = response.at(model.places).mean - response.at(rightly).mean;
      for (const auto& run : runs[i].seen) seen += response.whitened(run) / double(runs[i].seen.size());
      list[i].seen.push_back(std::move(seen));
      list[i].replicas = std::min(list[i].replicas, double(runs[i].seen.size()));
    }
  }
  std::erase_if(list, [](const FurtherCondition& c) { return c.replicas < 1; });
  return next_experiments(rivals, suspects, data, list);
}

}  // namespace tumble::diagnose
