#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/statistics.h"

// What was measured on a mill: EXPERIMENTS.toml. An experiment is the mill of MILL.toml with some keys set otherwise,
// and the data that it brought; what it did not bring is NaN or empty.
namespace tumble {

struct Experiment {
  std::string name;
  std::string place;                                      // "experiments.toml:12: J35-70", for messages
  std::vector<std::pair<std::string, std::string>> sets;  // key and value, as --set takes them
  bool hold_out = false;                                  // never used to choose or fit, only to test the prediction

  // With one standard deviation of the measurement; power and torque are the whole mill's.
  Estimate power;   // [W]
  Estimate torque;  // [N m]
  Estimate toe_deg, shoulder_deg, toe_bulk_deg, shoulder_bulk_deg, toe_outer_deg, shoulder_outer_deg;

  std::filesystem::path film, motion, tracks;  // where they are, seen from the working folder
  std::filesystem::path torque_series;         // of the whole mill
};

struct UncertainKey {  // what MILL.toml does not know exactly
  std::string key;
  double sd = kNotGiven;  // one standard deviation, > 0
  std::string place;      // "experiments.toml:40: contact.friction"
};

struct Experiments {
  std::string file;
  std::vector<Experiment> list;
  std::vector<UncertainKey> uncertain;
};

// The scalar data that an experiment may hold: the key in EXPERIMENTS.toml, and the same quantity of a run.
struct ScalarDatum {
  const char* name;  // "toe_deg"
  const char* unit;  // "deg"
  Estimate Experiment::*measured;
  bool is_direction;
};
inline constexpr std::array kScalarData{
    ScalarDatum{"power_W", "W", &Experiment::power, false},
    ScalarDatum{"torque_N_m", "N m", &Experiment::torque, false},
    ScalarDatum{"toe_deg", "deg", &Experiment::toe_deg, true},
    ScalarDatum{"shoulder_deg", "deg", &Experiment::shoulder_deg, true},
    ScalarDatum{"toe_bulk_deg", "deg", &Experiment::toe_bulk_deg, true},
    ScalarDatum{"shoulder_bulk_deg", "deg", &Experiment::shoulder_bulk_deg, true},
    ScalarDatum{"toe_outer_deg", "deg", &Experiment::toe_outer_deg, true},
    ScalarDatum{"shoulder_outer_deg", "deg", &Experiment::shoulder_outer_deg, true},
};

}  // namespace tumble
