#pragma once
#include "core/diagnosis.h"
#include "diagnose/proofs.h"

// What to measure next, where several suspects are left.
namespace tumble::diagnose {

// Of kinds of data that are missing, of longer runs, of other speeds and fillings: best first, by what each is expected
// to add to the ln of the evidence, over its cost. The rivals' mills are simulated at each other speed and filling.
std::vector<NextExperiment> what_next(const Posterior& posterior, const std::vector<Condition>& conditions,
                                      const std::vector<Fitted>& fitted, const Bench& bench, const Progress& progress);

}  // namespace tumble::diagnose
