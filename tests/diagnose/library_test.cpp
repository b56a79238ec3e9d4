#include "diagnose/library.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "diagnose/features.h"
#include "diagnose/observe.h"
#include "tests/diagnose/seen_mill.h"

namespace tumble::diagnose {
namespace {

// Worn lifters and eight balls more than he was told who measures it, by motion capture that does not err.
TEST(Signatures, SeeAMillAsWhoMeasuresItDoes) {
  Config believed = paper_mill(), real = paper_mill();
  real.charge.count = 120;
  const std::map<std::string, EffectSettings> wear{{"lifter_wear", {{"height_loss", {0.3}}, {"rounding", {0.005}}}}};
  real.effects = wear;
  real.run.spin_up = believed.run.spin_up = 1;
  const SignatureRun signature = run_signature(real, believed, {}, Watched::kRight);
  ASSERT_TRUE(signature.error.empty()) << signature.error;

  SimulatedRun run;
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& s) { run.setup = s; };
  sink.frame = [&](const Frame& f) { run.frames.push_back(f); };
  Config config = bare(real);
  config.run.seed = real.run.seed;
  sim::simulate(config, sink);
  Errors none;
  none.noise = none.angle_noise = none.torque_noise = 0;
  Measurement m = measure(run, none, 1);
  m.config = believed;

  const ObservationLayout layout(18);
  const std::vector<double> by_library = observed_at(signature.seen, kSpans[0]);
  const std::vector<double> by_tracks = observe(m, layout, kSpans[0]).value;
  const auto apart = [&](Observable o) {  // the library looks at every second frame
    double squares = 0, all = 0;
    for (std::size_t i = layout.first(o); i < layout.first(o) + layout.count(o); ++i) {
      squares += (by_library[i] - by_tracks[i]) * (by_library[i] - by_tracks[i]);
      all += by_library[i] * by_library[i];
    }
    return std::sqrt(squares / all);
  };
  for (const Observable o :
       {Observable::kOccupancy, Observable::kMomentum, Observable::kAgitation, Observable::kSpin, Observable::kPockets})
    EXPECT_LT(apart(o), 0.02) << name_of(o);
  const double torque = by_library[layout.first(Observable::kTorque)];
  EXPECT_NEAR(by_tracks[layout.first(Observable::kTorque)], torque, 0.002 * torque);
  const std::size_t closure = layout.first(Observable::kClosure);
  EXPECT_GT(std::abs(by_library[closure]), 0.04 * torque);  // eight balls' weight
  EXPECT_NEAR(by_tracks[closure], by_library[closure], 0.01 * torque);
}

}  // namespace
}  // namespace tumble::diagnose
