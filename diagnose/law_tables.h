#pragma once
#include <span>
#include <string>
#include <vector>

#include "diagnose/contact_laws.h"

namespace tumble::diagnose {

// The keys of MILL.toml that put measured laws in place of the model's: tabulated restitution, friction and drag, of
// the laws that contradict the model by more than `least_z`. What else bends such a law in the model is switched off,
// for the table says it all. Empty where no table is called for.
std::vector<std::string> tabulated_sets(std::span<const MeasuredLaw> laws, const Config& model, double least_z = 4);

}  // namespace tumble::diagnose
