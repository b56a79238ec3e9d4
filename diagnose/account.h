#pragma once
#include "core/diagnosis.h"
#include "diagnose/proofs.h"

// Where model and measurement differ, before and after: gaps, places, maps, and what got worse.
namespace tumble::diagnose {

// `after` may be `before`; `runner_up` may be null. Scenes that were not simulated are left out.
void give_account(Diagnosis& diagnosis, const std::vector<Scene>& scenes, const Proof& before, const Proof& after,
                  const Proof* runner_up);

}  // namespace tumble::diagnose
