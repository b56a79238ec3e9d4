#pragma once
#include "core/diagnosis.h"
#include "diagnose/prove.h"

// Which further measurement would tell rivals apart, for the least effort.
namespace tumble::diagnose {

struct Rival {
  std::string name;  // of all of whom it accuses: "rolling_resistance", "a + b"
  Explanation explanation;
  double probability = 0;
};

// A kind of data that the conditions were not measured in, though the library tells of it.
struct FurtherData {
  std::string measure;             // in words: "film the mill"
  std::vector<Measured> measured;  // the same conditions, with that too; of `seen` only the size is used
  double cost = 1;
};

// Another speed or filling, and how the rivals' mills look there.
struct FurtherCondition {
  std::vector<std::pair<std::string, double>> set;
  std::string measure;
  // Of the nearest condition that has a library, in whose units the difference is taken.
  const Response* near = nullptr;
  std::vector<Eigen::VectorXd> seen;  // by rival: mean of its simulations there, Response::whitened
  double replicas = 1;                // simulations in each mean
  double cost = 1;
};

// By the ln of the evidence that is to be expected, sum of p_i p_j min |m_i - m_j|^2 / 2 (Box & Hill 1967), over the
// cost; best first. What is uncertain may make one rival look like the other.
std::vector<NextExperiment> next_experiments(const std::vector<Rival>& rivals, std::span<const Suspect> suspects,
                                             const std::vector<FurtherData>& data,
                                             const std::vector<FurtherCondition>& conditions);

}  // namespace tumble::diagnose
