#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/config.h"
#include "diagnose/contact_events.h"

// Laws that no effect of the registry has, found in what flights and impacts leave over the model's laws: the few terms
// of a dictionary that explain it. A term counts if it is among the best three in nine of ten redrawings of the films'
// parts (bootstrap over parts and not over points, which share their conditions), and holds in that half of the parts
// which did not choose it.
namespace tumble::diagnose {

struct FoundLaw {
  std::string of;    // "acceleration in flight", "restitution", "friction"
  std::string term;  // "|v| v"
  std::string unit;  // of the coefficient
  double coefficient = 0, se = 0;
  double inclusion = 0;           // share of the redrawings that have it
  double f_test_p = 1;            // the worse of two halves, each tested by what the other chose
  std::vector<std::string> sets;  // of MILL.toml, for all terms found of this law; empty where no table says it
};

struct SeenExperiment {
  const ContactEvents* events = nullptr;
  const Config* model = nullptr;  // complete; what the sets are added to
};

std::vector<FoundLaw> found_laws(std::span<const SeenExperiment> experiments);

}  // namespace tumble::diagnose
