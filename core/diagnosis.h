#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/mill_shape.h"
#include "core/statistics.h"

// What a diagnosis found: verdict.json (contract, section 5) and the report are written from this alone.
namespace tumble {

enum class Finding { kMissingEffect, kAgreement, kMeasurementArtefact, kUnknownEffect, kAmbiguous };
enum class NameKind { kPhysics, kArtefact, kNone, kUnknown };

inline const char* name_of(Finding finding) {
  constexpr const char* names[] = {"missing_effect", "agreement", "measurement_artefact", "unknown_effect",
                                   "ambiguous"};
  return names[static_cast<int>(finding)];
}
inline const char* name_of(NameKind kind) {
  constexpr const char* names[] = {"physics", "artefact", "none", "unknown"};
  return names[static_cast<int>(kind)];
}

struct DiagnosedExperiment {
  std::string name;
  std::string data;  // what it brought, in words: "torque, film"
  bool hold_out = false;
  double speed_fraction = kNotGiven, filling = kNotGiven;
  MillShape shape;  // drawn round the maps
  // What makes its mill that of the model as it was with its uncertain keys refitted, as --set takes it.
  std::vector<std::string> before = {};
};

struct FoundParameter {
  std::string name, unit;  // as in MILL.toml; of an artefact: "relative", "angle_deg"
  Estimate value;
};

struct FoundEffect {  // what was added to the model, or may be what is missing
  std::string name;
  NameKind kind = NameKind::kPhysics;
  std::vector<FoundParameter> parameters;
  double probability = kNotGiven;  // that it is in the model
  // What goes with it at any strength, as --set takes it: "effects.lifter_wear.lifters=[4]".
  std::vector<std::string> sets = {};
};

struct RankedName {
  std::string name;
  NameKind kind = NameKind::kPhysics;
  double probability = 0;         // that it is in the model
  FoundParameter strength = {};   // where it alone were to explain the data
  double misfit = kNotGiven;      // reduced chi of the data then
  std::string ruled_out_by = {};  // "spin, at 0.9 of critical"; empty where it is not ruled out
};

struct PlaceOfGap {  // one number of one experiment in which model and measurement differ
  std::string experiment, observable, region;
  double z = kNotGiven, z_after = kNotGiven;  // measured less simulated, in standard errors
};

struct GapMap {  // an observable of one experiment over the mill, or over the drum's pockets
  std::string experiment = {}, observable = {}, unit = {};
  int n = 0;                // cells along the edge, row by row from the lowest y; 0: pockets round the drum
  double cell = kNotGiven;  // edge [R]
  std::vector<double> measured = {}, before = {}, after = {};  // numbers; NaN beyond the shell
  std::vector<double> z_before = {}, z_after = {};             // measured less simulated, in standard errors
  double limit = kNotGiven;  // |z| that chance alone exceeds somewhere on the map in one of twenty diagnoses
};

struct GapRow {  // one experiment, simulated anew
  std::string experiment;
  bool hold_out = false;
  // Reduced chi of the measured numbers: 1 is agreement. Of the model as it was with its uncertain keys refitted, of
  // the model with what was found, and of that with the runner-up instead.
  double before = kNotGiven, after = kNotGiven, runner_up = kNotGiven;
  Estimate torque_measured, torque_before, torque_after;  // [N m] of one slice
};

struct GapWorse {  // an observable that the repair made worse
  std::string experiment, observable;
  double before = kNotGiven, after = kNotGiven;  // reduced chi
};

struct CheckRow {  // an exact check, without simulation
  std::string experiment, name, unit;
  double found = kNotGiven, expected = kNotGiven, se = kNotGiven, z = kNotGiven;
  std::string says;
};

struct LawCurve {  // a law measured contact by contact, over the model's
  std::string experiment = {}, name = {}, x_name = {}, x_unit = {}, y_name = {}, y_unit = {};
  std::vector<double> x = {}, y = {}, se = {}, model = {};
  double z = kNotGiven;  // against the model's law
  std::string says = {};
};

struct TorqueCurve {  // torque over a lifter's passage or over time, measured and simulated with bands
  std::string experiment = {}, x_name = {}, x_unit = {};
  // [N m] of one slice.
  std::vector<double> x = {}, measured = {}, before = {}, before_se = {}, after = {}, after_se = {};
  std::vector<double> measured_se = {};
};

struct NextExperiment {
  std::vector<std::pair<std::string, double>> set;  // keys of MILL.toml
  std::string measure;                              // what to do, in words: "film the balls with marks that show spin"
  std::vector<std::string> separates;
  double expected_log_evidence = kNotGiven;
  double cost = kNotGiven;  // relative to another film like those given
};

struct FittedUncertain {  // a key that MILL.toml did not know exactly
  std::string key;
  double given = kNotGiven, given_sd = kNotGiven;
  Estimate found;
};

struct Diagnosis {
  std::string mill, measured;  // names of the files
  Finding finding = Finding::kAgreement;
  std::string sentence;  // the verdict in one or two sentences, for an engineer
  std::vector<DiagnosedExperiment> experiments;
  std::vector<FoundEffect> effects;  // those added; of an ambiguous verdict all that cannot be told apart
  std::vector<RankedName> ranking;   // every suspect, likeliest first
  std::vector<PlaceOfGap> where;     // beyond chance
  std::vector<GapMap> maps;
  std::vector<GapRow> gaps;
  std::string runner_up;  // empty without
  std::vector<GapWorse> worse;
  std::vector<CheckRow> checks;
  std::vector<LawCurve> laws;
  std::vector<std::string> found_laws;  // terms outside the registry, in words
  std::vector<TorqueCurve> torque;
  std::vector<NextExperiment> next;  // best first
  std::vector<FittedUncertain> keys;
  std::vector<std::vector<std::string>> alike;  // names that these data cannot tell apart, known before they were seen
  std::vector<std::string> caveats;
  std::string mill_toml;             // the text of MILL.toml
  std::string model_toml;            // the same with what was found added
  std::string model_tabulated_toml;  // with a law found by regression; empty without
  int simulations = 0;
  double seconds = 0;
};

// Root of the mean of the squares over the fitted, or held-out, experiments; NaN where there are none.
struct Gap {
  double fit = kNotGiven, hold_out = kNotGiven;
};
// The one of this name; nothing where there is none.
const DiagnosedExperiment* experiment_of(const Diagnosis& diagnosis, const std::string& name);

Gap gap_before(const Diagnosis& diagnosis);
Gap gap_after(const Diagnosis& diagnosis);
Gap gap_of_runner_up(const Diagnosis& diagnosis);

}  // namespace tumble
