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

// How far off the polynomial of a condition was, where it was simulated.
struct FoundError {
  Eigen::VectorXd places;  // keys and strengths
  Eigen::VectorXd shift;   // mean of the runs less expected
  double runs = 0;
  double scatter = 1;  // variance of the runs about their mean, against the usual one
};
using FoundErrors = std::vector<std::vector<FoundError>>;  // by fitted condition

struct Proof {
  Accusation accusation;
  Model model;                 // that was simulated
  std::vector<Replicas> runs;  // by scene; empty where it was not simulated
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

// Adds what the proof's runs say of the polynomials.
void find_errors(FoundErrors& errors, const Proof& proof, const std::vector<Fitted>& fitted,
                 const std::vector<Scene>& scenes);

// The case with the polynomials put right about this explanation's places, by all that was found, the nearer the more
// (kriging of what the polynomials leave): the same error is the same to all accusations near by, however few the runs.
Case corrected(const Case& of, const FoundErrors& errors, const Explanation& about);

// Whether what is now believed lies so far from what was simulated that it takes other simulations.
bool has_moved(const Proof& proof, std::size_t keys);

}  // namespace tumble::diagnose
