#pragma once
#include <functional>
#include <vector>

#include "core/experiments.h"
#include "diagnose/build_library.h"
#include "diagnose/evidence.h"
#include "diagnose/measurement.h"

// The proof of a verdict: the model as it is said to be, simulated anew in every experiment, those held out included,
// against what was measured there.
namespace tumble::diagnose {

// The uncertain keys' values and the guilty suspects' strengths, of an Explanation.
struct Model {
  Eigen::VectorXd places;
  int lifter = 0;  // of suspects that turn with the drum
};

struct Scene {  // an experiment with all that it takes to simulate it under a model
  const Measurement* measurement = nullptr;
  std::vector<Suspect> suspects;  // of its own config: full strengths hang on it
  std::vector<double> middle;     // of the uncertain keys
  double span = kNotGiven;
  double torque_unit = 0;  // mean torque of the fitted experiments [N m of one slice]
};

// What makes the scene's mill that of the model, as --set takes it.
std::vector<std::string> sets_of(const Scene& scene, const std::vector<UncertainKey>& uncertain, const Model& model);
// A value of an uncertain key that no mill can have (a restitution above 1) gives way to one nearer to MILL.toml's.
void make_possible(Model& model, const std::vector<Scene>& scenes, const std::vector<UncertainKey>& uncertain,
                   const MillWith& mill_with);
// The experiment's numbers as they would be without the errors of measurement that the model knows of.
std::vector<double> corrected(const Scene& scene, const Model& model, std::vector<double>& noise);

struct Replicas {                         // runs of one scene under one model, alike but for their packing
  std::vector<std::vector<double>> seen;  // by run: numbers of an Observation
  double revolutions = 0;                 // of one, that were looked at
};

// `seeds` runs of each scene, all side by side; by scene. Runs that fail are left out.
std::vector<Replicas> resimulate(const std::vector<Scene>& scenes, const std::vector<UncertainKey>& uncertain,
                                 const Model& model, std::size_t seeds, const MillWith& mill_with,
                                 const Progress& progress = {});

// What chance does to the numbers of one run, by several sets of runs of one scene.
struct Chance {
  std::vector<double> scatter;  // of each number, about the means of their sets
  // Of each run, each number's z against the other runs of its set, by the scatter of all runs but this one.
  std::vector<std::vector<double>> left_out;
};
Chance chance_of(const std::vector<const Replicas*>& sets);

// |z| that chance alone exceeds somewhere among the numbers [first, first + count) in one diagnosis of twenty.
double chance_limit(const Chance& chance, std::size_t first, std::size_t count);

// Of the numbers that the scene's experiment has: measured, mean of the runs, and z of the difference by what chance
// does to a run, to their mean, and by the measurement's own noise.
struct Contrast {
  std::vector<std::size_t> numbers;  // which
  std::vector<double> measured, simulated, z;
  double chi = kNotGiven;  // root of the mean of z^2, in units of that of the middle run left out: 1 is agreement
};
Contrast contrast(const Scene& scene, const Model& model, const Replicas& runs, const Chance& chance);

}  // namespace tumble::diagnose
