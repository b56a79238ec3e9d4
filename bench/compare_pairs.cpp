// How `compare` judges mills that are equal: compares the first motion file with the second, the third with the fourth,
// and so on, and prints the one number, what was named beyond chance, and each kind's mean square z. With --against
// FILE every file is compared with that one.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "diagnose/compare.h"
#include "io/motion_file.h"

int main(int argc, char** argv) {
  using namespace tumble;
  CLI::App app{"How compare judges pairs of motion files"};
  std::vector<std::string> files;
  std::string against;
  app.add_option("files", files, "MOTION.h5 ...")->required();
  app.add_option("--against", against, "MOTION.h5 that every file is compared with");
  CLI11_PARSE(app, argc, argv);

  double sum = 0, squares = 0;
  int pairs = 0, differ = 0;
  const std::size_t step = against.empty() ? 2 : 1;
  for (std::size_t i = 0; i + step <= files.size(); i += step) {
    const ChargeMotion a = io::read_motion(against.empty() ? files[i] : against);
    const Deviation d = diagnose::compare(a, io::read_motion(files[i + step - 1]));
    fmt::print("{:.2f} (< {:.2f}) {:7}", d.chi, d.chi_limit, name_of(d.verdict));
    for (const Agreement& of : d.agreements) fmt::print("  {} {:.2f}", of.name, of.mean_square);
    fmt::print(" |");
    for (const Difference& one : d.differences)
      if (one.significant) fmt::print(" {} {:.1f}", one.name, one.z);
    for (const auto* many : {&d.fields, &d.lines})
      for (const SampledDifference& one : *many)
        if (one.beyond_chance > 0) fmt::print(" {} {}/{}", one.name, one.beyond_chance, one.compared);
    fmt::print("\n");
    ++pairs;
    differ += d.verdict == Verdict::kDiffer;
    sum += d.chi;
    squares += d.chi * d.chi;
  }
  const double mean = sum / pairs;
  fmt::print("{} pairs: number {:.2f} +- {:.2f}, root of its mean square {:.2f}; {} called different\n", pairs, mean,
             std::sqrt(std::max(0.0, squares / pairs - mean * mean)), std::sqrt(squares / pairs), differ);
}
