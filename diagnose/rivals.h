#pragma once
#include <span>
#include <string>
#include <vector>

#include "diagnose/evidence.h"

// How far apart suspects lie in what a set of measurements can see of them.
namespace tumble::diagnose {

// How much worse `by` explains, at its best, what would be measured were the places these: in ln of the likelihood,
// and so in ln of the evidence but for the price of a parameter. `measured` tells of conditions, not of data.
double separation(std::span<const Measured> measured, std::span<const Suspect> suspects, const Eigen::VectorXd& places,
                  const std::vector<int>& by);

// Pairs of names that these conditions and kinds of data can hardly tell apart (ln of the evidence below 4.5, three
// standard deviations), each at full strength, known before any data are seen.
std::vector<std::vector<std::string>> alike(std::span<const Measured> measured, std::span<const Suspect> suspects);

}  // namespace tumble::diagnose
