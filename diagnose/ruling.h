#pragma once
#include <set>
#include <string>
#include <vector>

#include "core/diagnosis.h"
#include "diagnose/posterior.h"

// What the probabilities come to: a verdict, the names that it accuses, and the ranking of all.
namespace tumble::diagnose {

std::set<std::string> names_of(const Accusation& accusation, std::span<const Suspect> suspects);

std::string joined(const std::set<std::string>& names);  // "camera_scale + cohesion"

struct Ruling {
  Finding finding = Finding::kAgreement;
  std::set<std::string> names;
};
Ruling rule(const Posterior& posterior, std::span<const Suspect> suspects);

// Of each name: how probable, and how strong it would be alone. `keys`: the number of uncertain keys; `experiments`:
// the names of those fitted.
std::vector<RankedName> ranking_of(const Posterior& posterior, std::span<const Suspect> suspects, int keys,
                                   const std::vector<std::string>& experiments);

// Those that the ruling names, as strong as the likeliest accusation of each has them.
std::vector<FoundEffect> effects_of(const Ruling& ruling, const Posterior& posterior, std::span<const Suspect> suspects,
                                    int keys);

}  // namespace tumble::diagnose
