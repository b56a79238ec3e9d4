#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>

#include "diagnose/exact_checks.h"
#include "io/run_file.h"
#include "tests/diagnose/seen_mill.h"

// How honest the errors of the exact checks are: each run file is measured by somebody who errs as told, with noise of
// its own; a row for each check, over all files. docs/measurements.md, "How good they are".
using namespace tumble;
using namespace tumble::diagnose;

namespace {

struct Row {
  std::string unit;
  double found = 0, expected = 0, se = 0, strength = 0, z = 0, zz = 0, n = 0;
};

SimulatedRun run_in(const std::string& file) {
  const io::RunReader reader(file);
  SimulatedRun run{reader.setup(), {}};
  for (std::size_t i = 0; i < reader.frame_count(); ++i) run.frames.push_back(reader.frame(i));
  return run;
}

}  // namespace

int main(int argc, char** argv) {
  Errors errors;
  errors.torque_noise = 0.2;
  double roll_deg = 0;
  std::vector<std::string> files;
  CLI::App app("Exact checks of runs as somebody who errs sees them");
  app.add_option("runs", files, "RUN.h5 ...")->required();
  app.add_option("--noise", errors.noise, "Of places, m");
  app.add_option("--torque-noise", errors.torque_noise, "Of a sample, N m");
  app.add_option("--scale", errors.scale, "Lengths are seen longer by this share");
  app.add_option("--roll-deg", roll_deg, "All is seen turned counter-clockwise by this");
  app.add_option("--clock", errors.clock, "Times are taken as longer by this share");
  app.add_option("--torque-offset", errors.torque_offset, "Share of the mean torque");
  app.add_option("--lost", errors.lost, "Share of the sightings that are lost");
  CLI11_PARSE(app, argc, argv);
  errors.rotation = roll_deg * kPi / 180;

  std::map<std::string, Row> rows;
  std::uint64_t seed = 1000;
  for (const std::string& file : files)
    for (const ExactCheck& c : exact_checks(measure(run_in(file), errors, ++seed))) {
      Row& r = rows[c.name];
      r.unit = c.unit;
      r.found += c.found;
      r.expected += c.expected;
      r.se += c.se;
      r.strength += c.strength;
      r.z += c.z;
      r.zz += c.z * c.z;
      r.n += 1;
    }
  fmt::print("{:16} {:>4} {:>11} {:>11} {:>9} {:>9} {:>7} {:>7}\n", "check", "runs", "found", "expected", "se",
             "strength", "mean z", "rms z");
  for (const auto& [name, r] : rows)
    fmt::print("{:16} {:4} {:11.5g} {:11.5g} {:9.2g} {:9.3g} {:7.2f} {:7.2f}  {}\n", name, r.n, r.found / r.n,
               r.expected / r.n, r.se / r.n, r.strength / r.n, r.z / r.n, std::sqrt(r.zz / r.n), r.unit);
}
