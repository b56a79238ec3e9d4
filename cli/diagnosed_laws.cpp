#include "cli/diagnosed_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <string>

#include "diagnose/contact_laws.h"
#include "diagnose/found_laws.h"
#include "diagnose/law_tables.h"
#include "io/config_file.h"
#include "io/diagnosis_file.h"

namespace tumble::cli {
namespace {

using diagnose::FoundLaw;
using diagnose::Measurement;

// Terms of found_laws, as a sentence has them.
std::string words_of_term(const FoundLaw& law) {
  struct Words {
    const char *term, *words;
  };
  constexpr std::array kOfFlight{
      Words{"x", "a steady push to the right, {} {}"},
      Words{"y", "a steady push upwards, {} {}"},
      Words{"v", "a push along the velocity and in proportion to it, {} {}"},
      Words{"|v| v", "a push along the velocity that grows with its square, {} {}"},
      Words{"v / |v|", "a push along the velocity, as strong at every speed, {} {}"},
      Words{"u / |u|", "a push along the velocity seen from the turning drum, as strong at every speed, {} {}"},
      Words{"z x v", "a push to the left of the velocity and in proportion to it, {} {}"},
      Words{"spin z x v", "a push across the velocity that grows with spin, {}{} z × ω v"},
      Words{"r", "a push away from the axis that grows with the distance from it, {} {}"},
      Words{"z x r", "a push round the axis that grows with the distance from it, {} {}"}};
  constexpr std::array kOfImpacts{Words{"1", "the same at all speeds, {}{}"},
                                  Words{"v_n", "in proportion to the normal speed, {} {}"},
                                  Words{"v_n^2", "with the square of the normal speed, {} {}"},
                                  Words{"slip", "in proportion to the sliding speed, {} {}"},
                                  Words{"slip^2", "with the square of the sliding speed, {} {}"},
                                  Words{"size", "with the balls’ size over the mean size less 1, {}{}"},
                                  Words{"wall", "at the wall alone, {}{}"}};
  const std::string amount = fmt::format("{:+.3g} ± {:.2g}", law.coefficient, law.se);
  const auto said_by = [&](const auto& list) -> std::string {
    for (const Words& w : list)
      if (law.term == w.term) return fmt::format(fmt::runtime(w.words), amount, law.unit);
    return fmt::format("{}, {} {}", law.term, amount, law.unit);
  };
  return law.of == "acceleration in flight" ? "balls in flight: " + said_by(kOfFlight)
                                            : law.of + " beyond the model’s: " + said_by(kOfImpacts);
}

// The mill as the gap before the repair has it: what its uncertain keys can explain is no law.
Config refitted(const Diagnosis& d, const Measurement& m) {
  for (const DiagnosedExperiment& e : d.experiments)
    if (e.name == m.experiment.name) return io::with_sets(m.config, e.before);
  return m.config;
}

// Tables of the laws for which the dictionary has words; where it has none, of the measured laws themselves.
std::vector<std::string> tables_of(const std::vector<FoundLaw>& found, const std::vector<Measurement>& measurements,
                                   const std::deque<Config>& models) {
  std::vector<std::string> sets;
  for (const FoundLaw& law : found)
    for (const std::string& set : law.sets)
      if (std::find(sets.begin(), sets.end(), set) == sets.end()) sets.push_back(set);
  auto model = models.begin();
  for (const Measurement& m : measurements) {
    if (!sets.empty()) break;
    if (m.experiment.hold_out || m.frames.empty()) continue;
    sets = diagnose::tabulated_sets(diagnose::measured_laws(m.frames, *model), *model);
    ++model;
  }
  return sets;
}

void find_laws(Diagnosis& d, const std::vector<Measurement>& measurements) {
  std::deque<Config> models;  // of the fitted experiments with frames, in their order
  std::deque<diagnose::ContactEvents> events;
  std::vector<diagnose::SeenExperiment> seen;
  for (const Measurement& m : measurements) {
    if (m.experiment.hold_out || m.frames.empty()) continue;
    models.push_back(refitted(d, m));
    events.emplace_back(models.back());
    for (const diagnose::SeenFrame& f : m.frames) events.back().add(f.time, f.mill_angle, f.balls);
    seen.push_back({&events.back(), &models.back()});
  }
  const std::vector<FoundLaw> found = diagnose::found_laws(seen);
  for (const FoundLaw& law : found)
    d.found_laws.push_back(
        fmt::format("{}; in {:.0f} % of the samples drawn anew.", words_of_term(law), 100 * law.inclusion));
  const std::vector<std::string> sets = tables_of(found, measurements, models);
  if (!sets.empty()) d.model_tabulated_toml = io::tabulated_mill(d.mill_toml, d.mill, d, sets);
}

}  // namespace

void add_laws(Diagnosis& d, const std::vector<Measurement>& measurements) {
  for (const Measurement& m : measurements) {
    if (m.frames.empty()) continue;
    for (diagnose::MeasuredLaw& law : diagnose::measured_laws(m.frames, m.config))
      d.laws.push_back({m.experiment.name, law.name, law.x_name, law.x_unit, law.y_name, law.y_unit, std::move(law.x),
                        std::move(law.y), std::move(law.se), std::move(law.model), law.z, law.says});
  }
  if (d.finding == Finding::kUnknownEffect) find_laws(d, measurements);
}

}  // namespace tumble::cli
