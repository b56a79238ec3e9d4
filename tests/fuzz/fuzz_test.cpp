#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/fuzz/fuzz_run.h"

namespace tumble::fuzz {
namespace {

// TUMBLE_FUZZ_MILLS and TUMBLE_FUZZ_SEED ask for more, or other mills; bench/fuzz_mills also shrinks what fails.
long asked(const char* variable, long otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atol(text) : otherwise;
}

TEST(Fuzz, RandomMillsTurnWithoutALeak) {
  const long mills = asked("TUMBLE_FUZZ_MILLS", 300);
  Random random(static_cast<std::uint64_t>(asked("TUMBLE_FUZZ_SEED", 1)));
  Tally tally;
  long no_room = 0, touched = 0;
  for (long k = 0; k < mills; ++k) {
    const Case c = random_mill(random, 3e6, tally);
    const Outcome o = run(c);
    no_room += o.kind == "no_room";
    touched += o.deepest_wall > 0;
    if (!o.kind.empty() && o.kind != "no_room")
      ADD_FAILURE() << o.kind << ": " << o.what << "\n# start: " << kStartNames[static_cast<int>(c.start)] << "\n"
                    << io::to_toml(c.config);
  }
  EXPECT_LT(no_room, 0.01 * double(mills) + 1) << "so many hardly fit";
  EXPECT_GT(touched, mills / 2) << "most mills must have had something to go wrong";
  EXPECT_LT(tally.not_valid, mills / 2) << "drawn in vain";
}

// Shrunk from mills that failed once.
Outcome run_toml(const std::string& toml, Start start) { return run(Case{io::parse_config(toml, "fuzz.toml"), start}); }

// A ball that sticks to a wall whose speed varies: what it slides and rolls was taken with the wall's speed at the end
// of the step, and 3e-3 of the energy went missing, in the first order of the time step.
TEST(Fuzz, ABallOnARipplingWallKeepsItsEnergy) {
  const Outcome o = run_toml(R"(
    mill = { diameter = 0.128, speed_rpm = 153, lifters = { profile = "none" } }
    charge = { count = 1, balls = [ { radius = 0.0215, mass = 0.107 } ] }
    contact = { normal_stiffness = 6.65e5, tangential_stiffness = 4.76e5, friction = 0, restitution = 0.25 }
    run = { seed = 854346 }
    effects.cohesion = { force = 1 }
    effects.rolling_resistance = { coefficient = 0.55 }
    effects.speed_ripple = { amplitude = 0.425, order = 37, phase_deg = -96 })",
                             Start::kLoose);
  EXPECT_EQ(o.what, "");
  EXPECT_LT(o.energy_error, 2e-4);
}

}  // namespace
}  // namespace tumble::fuzz
