#include "diagnose/law_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/effects.h"

namespace tumble::diagnose {
namespace {

const MeasuredLaw* contradicting(std::span<const MeasuredLaw> laws, const std::string& name, double least_z) {
  for (const MeasuredLaw& l : laws)
    if (l.name == name && l.z > least_z) return &l;
  return nullptr;
}

double at(const MeasuredLaw& law, double x) {
  if (x <= law.x.front()) return law.y.front();
  for (std::size_t k = 1; k < law.x.size(); ++k)
    if (x <= law.x[k]) return law.y[k - 1] + (law.y[k] - law.y[k - 1]) * (x - law.x[k - 1]) / (law.x[k] - law.x[k - 1]);
  return law.y.back();
}

// Both columns of one effect, at the speeds at which either law is known.
void add_table(std::vector<std::string>& sets, const char* effect, const char* column, const MeasuredLaw* balls,
               const MeasuredLaw* wall, double factor, double least, double most) {
  std::vector<double> speeds;
  for (const MeasuredLaw* law : {balls, wall})
    if (law) speeds.insert(speeds.end(), law->x.begin(), law->x.end());
  if (speeds.empty()) return;
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end(), [](double a, double b) { return b < 1.001 * a; }),
               speeds.end());
  sets.push_back(fmt::format("effects.{}.speed=[{:.4g}]", effect, fmt::join(speeds, ", ")));
  for (const MeasuredLaw* law : {balls, wall}) {
    if (!law) continue;
    std::vector<double> values;
    for (const double v : speeds) values.push_back(std::clamp(factor * at(*law, v), least, most));
    sets.push_back(
        fmt::format("effects.{}.{}{}=[{:.4g}]", effect, law == wall ? "wall_" : "", column, fmt::join(values, ", ")));
  }
}

}  // namespace

std::vector<std::string> tabulated_sets(std::span<const MeasuredLaw> laws, const Config& model, double least_z) {
  std::vector<std::string> sets;
  const auto none = [&](const char* effect, const char* strength) {
    if (has_effect(model, effect)) sets.push_back(fmt::format("effects.{}.{}=0", effect, strength));
  };
  const auto law = [&](const char* name) { return contradicting(laws, name, least_z); };
  add_table(sets, "tabulated_restitution", "restitution", law("restitution, ball on ball"),
            law("restitution, ball on wall"), 1, 0.01, 1);
  if (!sets.empty()) none("impact_restitution", "drop");
  const std::size_t before = sets.size();
  const double share = friction_share(model);
  if (share > 0)
    add_table(sets, "tabulated_friction", "friction", law("friction, ball on ball"), law("friction, ball on wall"),
              1 / share, 0, 10);
  if (sets.size() > before) {
    none("friction_weakening", "drop");
    none("wall_friction", "increase");
  }
  if (const MeasuredLaw* drag = law("drag")) {
    double mass = 0, shares = 0;
    for (const BallClass& b : model.charge.balls) mass += b.share * b.mass, shares += b.share;
    std::vector<double> coefficients;
    for (std::size_t k = 0; k < drag->x.size(); ++k)
      coefficients.push_back(std::max(0.0, mass / shares * drag->y[k] / drag->x[k]));
    sets.push_back(fmt::format("effects.tabulated_drag.speed=[{:.4g}]", fmt::join(drag->x, ", ")));
    sets.push_back(fmt::format("effects.tabulated_drag.coefficient=[{:.4g}]", fmt::join(coefficients, ", ")));
    none("fluid_drag", "viscosity");
    none("fluid_drag", "density");
  }
  return sets;
}

}  // namespace tumble::diagnose
