#pragma once
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "diagnose/posterior.h"
#include "diagnose/prove.h"

// Accusations put to the proof: simulated anew where the polynomial says that they lie, which shows how far off it is.
namespace tumble::diagnose {

struct Fitted {  // a measurement that is not held out, and what is known of its condition
  std::size_t scene = 0;
  std::unique_ptr<Response> response;
  std::vector<std::vector<double>> by_lifter;  // its numbers, the drum turned on
};

// Throws InputError where the measurement brings nothing that the condition's runs show too. `further`: kinds of
// numbers that are taken as measured, exactly, though they were not.
Fitted fit(const Condition& condition, const Scene& scene, std::size_t index, const std::set<Observable>& further = {});

Case case_of(const std::vector<Fitted>& fitted, const std::vector<Scene>& scenes);

// How far off the polynomial is, of each fitted condition, by what was simulated there.
struct Correction {
  std::vector<Eigen::VectorXd> shift;
  std::vector<double> guess;  // variance that the polynomial itself expects of it
  // Orthonormal, where the keys and the guilty move the numbers.
  std::vector<Eigen::MatrixXd> directions;
  double runs = 0;  // of each condition, behind it; 0: nothing is known
};

struct Proof {
  Accusation accusation;
  Model model;                 // that was simulated
  std::vector<Replicas> runs;  // by scene; empty where it was not simulated
  Correction correction;
  Case corrected;  // by that
};

// How the scenes are simulated.
struct Bench {
  const std::vector<Scene>* scenes = nullptr;
  const std::vector<UncertainKey>* uncertain = nullptr;
  const MillWith* mill_with = nullptr;
  std::size_t seeds = 0;  // runs of a scene
};

// Simulates those of the proof's scenes that have no runs yet: the fitted ones, or those held out. Returns the number
// of runs.
std::size_t simulate(Proof& proof, const Bench& bench, bool held_out, const Progress& progress = {});

Proof proof_of(const Accusation& accusation, std::size_t scenes, std::size_t keys);

// What the proof's runs say of the polynomial, together with what is known from runs near by.
Correction correction_by(const Proof& proof, const std::vector<Fitted>& fitted, const std::vector<Scene>& scenes,
                         const Correction& before);

// The case with the polynomial put right. Few runs are a noisy word: all of it is believed in the few directions in
// which keys and strengths would make up for it; of the many others the less, the smaller the errors seem.
Case corrected(const Case& of, const Correction& correction);

// Whether what is now believed lies so far from what was simulated that it takes other simulations.
bool has_moved(const Proof& proof, std::size_t keys);

}  // namespace tumble::diagnose
