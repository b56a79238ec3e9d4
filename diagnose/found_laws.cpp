#include "diagnose/found_laws.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/effects.h"
#include "core/units.h"
#include "diagnose/law_samples.h"
#include "diagnose/sparse_terms.h"

namespace tumble::diagnose {
namespace {

constexpr std::size_t kParts = 24;  // that all experiments are cut into, in the order of time
constexpr std::size_t kLeast = 60;  // flights, impacts: fewer tell nothing of a law that nobody knows
constexpr double kSlowest = 0.16;   // normal speed from which an impact tells of restitution [sqrt(g D)]

struct Term {
  const char *name, *unit;
};

// Rows of a regression, in the order of time.
struct Rows {
  std::vector<Term> terms;
  struct Row {
    Eigen::VectorXd numbers;  // terms, then response
    double weight;
  };
  std::vector<Row> rows;
  std::size_t per_event = 1;

  void leave_out(const char* name) {
    const auto at =
        std::find_if(terms.begin(), terms.end(), [&](const Term& t) { return std::string(t.name) == name; });
    const auto k = at - terms.begin();
    terms.erase(at);
    for (Row& r : rows) {
      const Eigen::VectorXd old = r.numbers;
      r.numbers.resize(old.size() - 1);
      r.numbers << old.head(k), old.tail(old.size() - k - 1);
    }
  }
};

std::vector<SparseTerm> search(const Rows& data) {
  const std::size_t events = data.rows.size() / data.per_event;
  if (events < kLeast) return {};
  std::vector<TermSums> parts(kParts, TermSums(static_cast<int>(data.terms.size())));
  for (std::size_t k = 0; k < data.rows.size(); ++k)
    parts[k / data.per_event * kParts / events].add(data.rows[k].numbers, data.rows[k].weight);
  return sparse_terms(parts);
}

double mean_mass(const Config& config) {
  double sum = 0, shares = 0;
  for (const BallClass& b : config.charge.balls) sum += b.share * b.mass, shares += b.share;
  return sum / shares;
}

struct Model {
  explicit Model(const SeenExperiment& e) : seen(e), laws(*e.model) {}
  SeenExperiment seen;
  sim::ConfigLaws laws;
};

// --- acceleration in flight

constexpr const char* kStokes = "v";
constexpr const char* kNewton = "|v| v";

Rows rows_of_flights(const std::vector<std::unique_ptr<Model>>& models) {
  Rows data;
  data.per_event = 2;
  data.terms = {{"x", "m/s2"},       {"y", "m/s2"},    {kStokes, "1/s"},   {kNewton, "1/m"}, {"v / |v|", "m/s2"},
                {"u / |u|", "m/s2"}, {"z x v", "1/s"}, {"spin z x v", ""}, {"r", "1/s2"},    {"z x r", "1/s2"}};
  bool spins = true;
  for (const auto& m : models) {
    const double turn = m->laws.mill_speed(), usual = mean_radius(m->seen.model->charge.balls);
    for (const FlightWindow& w : m->seen.events->flights()) {
      const double small = usual / w.radius;
      spins &= std::isfinite(w.spin);
      // Both components of every term, then of the model's own acceleration.
      const auto features = mean_over<std::array<double, 22>>(w, [&](double x, double y, double vx, double vy) {
        const double v = std::hypot(vx, vy), ux = vx + turn * y, uy = vy - turn * x, u = std::hypot(ux, uy);
        const auto own = m->laws.acceleration({w.radius, w.mass, x, y, vx, vy});
        return std::array<double, 22>{1,
                                      0,
                                      0,
                                      1,
                                      small * small * vx,
                                      small * small * vy,
                                      small * v * vx,
                                      small * v * vy,
                                      vx / v,
                                      vy / v,
                                      ux / u,
                                      uy / u,
                                      -vy,
                                      vx,
                                      -w.spin * vy,
                                      w.spin * vx,
                                      x,
                                      y,
                                      -y,
                                      x,
                                      own[0],
                                      own[1]};
      });
      for (std::size_t axis = 0; axis < 2; ++axis) {
        Rows::Row row{Eigen::VectorXd(11), w.information};
        for (std::size_t k = 0; k < 10; ++k) row.numbers[static_cast<Eigen::Index>(k)] = features[2 * k + axis];
        row.numbers[10] = (axis == 0 ? w.ax : w.ay + kGravity) - features[20 + axis];
        data.rows.push_back(std::move(row));
      }
    }
  }
  if (!spins) data.leave_out("spin z x v");
  return data;
}

std::vector<std::string> sets_of_flights(const Rows& data, const std::vector<SparseTerm>& found, const Config& config) {
  double stokes = 0, newton = 0;
  for (const SparseTerm& s : found) {
    const std::string name = data.terms[static_cast<std::size_t>(s.term)].name;
    if (name == kStokes) stokes = -s.coefficient;
    if (name == kNewton) newton = -s.coefficient;
  }
  const double mass = mean_mass(config), fast = std::sqrt(kGravity * config.mill.diameter);
  const double slowly = mass * stokes, fastly = mass * (stokes + newton * fast);
  // A table cannot speed balls up, and one that the model has already is not added to.
  if ((stokes == 0 && newton == 0) || slowly < 0 || fastly < 0 || has_effect(config, "tabulated_drag")) return {};
  return {fmt::format("effects.tabulated_drag.speed=[0, {:.6g}]", fast),
          fmt::format("effects.tabulated_drag.coefficient=[{:.6g}, {:.6g}]", slowly, fastly),
          fmt::format("effects.tabulated_drag.radius_power={}", stokes >= newton * fast ? 1 : 2)};
}

// --- restitution and friction: polynomials of one speed, another at the wall

std::vector<double> speeds_up_to(double most) {
  std::vector<double> speeds;
  for (int k = 0; k < 7; ++k) speeds.push_back(most * k / 6);
  return speeds;
}

// y = (1, v, v^2, size, wall) `down` from samples of both kinds of impacts.
Rows rows_of_impacts(const std::vector<std::unique_ptr<Model>>& models, bool restitution) {
  Rows data;
  if (restitution)
    data.terms = {{"1", ""}, {"v_n", "s/m"}, {"v_n^2", "s2/m2"}, {"size", ""}, {"wall", ""}};
  else
    data.terms = {{"1", ""}, {"slip", "s/m"}, {"slip^2", "s2/m2"}, {"size", ""}, {"wall", ""}};
  bool sizes = false, at_wall = false, between = false;
  for (const auto& m : models) {
    const Config& config = *m->seen.model;
    const std::vector<SeenImpact> impacts = m->seen.events->impacts();
    std::vector<LawSample> samples;
    for (const bool wall : {false, true}) {
      const Law law = restitution ? (wall ? Law::kWallRestitution : Law::kBallRestitution)
                                  : (wall ? Law::kWallFriction : Law::kBallFriction);
      const auto some = samples_of(law, {}, impacts, config, &m->laws, {});
      samples.insert(samples.end(), some.begin(), some.end());
    }
    std::stable_sort(samples.begin(), samples.end(),
                     [](const LawSample& a, const LawSample& b) { return a.event < b.event; });
    const double slowest = restitution ? kSlowest * std::sqrt(kGravity * config.mill.diameter) : 0;
    const double usual = mean_radius(config.charge.balls);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      LawSample s = samples[k];
      const SeenImpact& e = impacts[static_cast<std::size_t>(s.event)];
      double weight = 1 / (1 / e.all.spread + 1 / e.spread_after);  // `up` and `down` carry it already
      if (restitution) {                                            // two ways to see one impact: one row
        const LawSample& t = samples[++k];
        weight = 2 / (1 / e.half[0].spread + 1 / e.spread_after);
        s = {s.event, s.key + t.key, 0.5 * (s.x + t.x), s.up + t.up, s.down + t.down, s.model + t.model};
        s.key /= 2;
      }
      if (!(s.key > slowest)) continue;
      const double down = s.down / weight, wall = e.at_wall;
      const double size = (e.at_wall ? e.radius_i : 0.5 * (e.radius_i + e.radius_j)) / usual - 1;
      sizes |= std::abs(size) > 1e-6;
      (e.at_wall ? at_wall : between) = true;
      Rows::Row row{Eigen::VectorXd(6), weight};
      row.numbers << down, down * s.x, down * s.x * s.x, down * size, down * wall, (s.up - s.model) / weight;
      data.rows.push_back(std::move(row));
    }
  }
  if (!sizes) data.leave_out("size");
  if (!at_wall || !between) data.leave_out("wall");
  return data;
}

std::vector<std::string> sets_of_impacts(const Rows& data, const std::vector<SparseTerm>& found, bool restitution,
                                         const Model& model) {
  const Config& config = *model.seen.model;
  const std::vector<double> speeds = speeds_up_to((restitution ? 1 : 2) * std::sqrt(kGravity * config.mill.diameter));
  const auto table = [&](bool wall) {
    std::vector<double> values;
    for (const double v : speeds) {
      double y = restitution ? model.laws.restitution(wall, v) : model.laws.friction(wall, v);
      for (const SparseTerm& s : found) {
        const std::string name = data.terms[static_cast<std::size_t>(s.term)].name;
        if (name == "1") y += s.coefficient;
        if (name == "v_n" || name == "slip") y += s.coefficient * v;
        if (name == "v_n^2" || name == "slip^2") y += s.coefficient * v * v;
        if (wall && name == "wall") y += s.coefficient;
      }
      values.push_back(restitution ? std::clamp(y, 0.01, 1.0) : std::clamp(y / friction_share(config), 0.0, 10.0));
    }
    return fmt::format("[{:.4g}]", fmt::join(values, ", "));
  };
  const std::string effect = restitution ? "effects.tabulated_restitution" : "effects.tabulated_friction";
  std::vector<std::string> sets{
      fmt::format("{}.speed=[{:.4g}]", effect, fmt::join(speeds, ", ")),
      fmt::format("{}.{}={}", effect, restitution ? "restitution" : "friction", table(false)),
      fmt::format("{}.wall_{}={}", effect, restitution ? "restitution" : "friction", table(true))};
  // The table says it all.
  const auto none = [&](const char* name, const char* strength) {
    if (has_effect(config, name)) sets.push_back(fmt::format("effects.{}.{}=0", name, strength));
  };
  if (restitution) {
    none("impact_restitution", "drop");
  } else {
    none("friction_weakening", "drop");
    none("wall_friction", "increase");
  }
  return sets;
}

void report(const char* of, const Rows& data, const std::vector<SparseTerm>& found,
            const std::vector<std::string>& sets, std::vector<FoundLaw>& out) {
  for (const SparseTerm& s : found) {
    const Term& t = data.terms[static_cast<std::size_t>(s.term)];
    out.push_back({of, t.name, t.unit, s.coefficient, s.se, s.inclusion, s.p, sets});
  }
}

}  // namespace

std::vector<FoundLaw> found_laws(std::span<const SeenExperiment> experiments) {
  std::vector<std::unique_ptr<Model>> models;
  for (const SeenExperiment& e : experiments) models.push_back(std::make_unique<Model>(e));
  std::vector<FoundLaw> all;
  if (models.empty()) return all;
  const Rows flights = rows_of_flights(models);
  const auto bent = search(flights);
  report("acceleration in flight", flights, bent, sets_of_flights(flights, bent, *experiments.front().model), all);
  for (const bool restitution : {true, false}) {
    const Rows impacts = rows_of_impacts(models, restitution);
    const auto found = search(impacts);
    if (!found.empty())
      report(restitution ? "restitution" : "friction", impacts, found,
             sets_of_impacts(impacts, found, restitution, *models.front()), all);
  }
  return all;
}

}  // namespace tumble::diagnose
