#pragma once
#include <string>
#include <vector>

#include "core/statistics.h"

namespace tumble {

struct Difference {       // one quantity in two sources
  std::string name = {};  // as in summary.json
  std::string unit = {};
  Estimate a = {}, b = {};
  double difference = kNotGiven;  // b - a; directions in [-180, 180)
  double se = kNotGiven;          // of the difference; NaN where one of the two has none
  double z = kNotGiven;           // difference / se
  double chance = kNotGiven;      // that two equal mills give such a |z| or a larger one
  bool significant = false;       // beyond chance, all that was compared beside it allowed for
  bool is_condition = false;      // what the mill was set to (speed, filling), not what the charge makes of it
  bool counts = true;             // towards the number and the verdict
  std::string note = {};          // why there is no difference, or why it does not count; may be empty
};

// A quantity along a line or over the grid of cells, place by place.
struct SampledDifference {
  std::string name = {}, unit = {};
  std::string x_name = {}, x_unit = {};  // of a line; empty for a grid
  std::vector<double> x = {};            // places; empty for a grid
  int n = 0;                             // cells along the grid's edge, row by row from the lowest y; 0 for a line
  double cell = kNotGiven;               // a cell's edge, in mill radii
  std::vector<double> a = {}, a_se = {}, b = {}, b_se = {};
  std::vector<double> difference = {}, se = {};  // b - a
  std::vector<double> z = {};                    // NaN where not compared
  std::vector<char> significant = {};            // beyond chance, all places of this quantity allowed for
  double mean_square = kNotGiven;                // of z, in units of a normal distribution's
  int compared = 0, beyond_chance = 0;           // places
  std::string where = {};                        // most of what is beyond chance, in words; empty where nothing is
};

struct Agreement {  // of one kind of numbers
  std::string name = {};
  int compared = 0;
  double mean_square = kNotGiven;  // of z, in units of a normal distribution's: 1 for equal mills
  double independent = 0;          // so many numbers would scatter as much, by experience with equal mills
};

struct BallPath {  // of one ball, mostly for one turn about the centre of circulation
  int ball = 0;
  double share = kNotGiven;  // of all such turns, those that stay nearer to the centre; NaN: asked for by number
  std::vector<double> time = {}, x = {}, y = {};  // from its start [s], [m]
};

enum class Verdict { kAgree, kDiffer, kUnknown };

struct Deviation {             // what `compare` finds between two charge motions
  std::string a = {}, b = {};  // their origins
  std::vector<Difference> differences = {};
  std::vector<SampledDifference> fields = {}, lines = {};
  std::vector<Agreement> agreements = {};
  // The one number: root of the mean square z, each kind of numbers weighing the same. 1 for equal mills, for which
  // 99 of 100 lie below `chi_limit`.
  double chi = kNotGiven, chi_limit = kNotGiven;
  Verdict verdict = Verdict::kUnknown;
  std::string sentence = {};  // the verdict in words
  std::vector<std::string> caveats = {};
};

inline const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAgree:
      return "agree";
    case Verdict::kDiffer:
      return "differ";
    case Verdict::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace tumble
