#include "diagnose/contact_laws.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/units.h"
#include "diagnose/found_laws.h"
#include "diagnose/law_tables.h"
#include "sim/simulator.h"

namespace tumble::diagnose {
namespace {

constexpr double kNoise = 0.0003, kSpinNoise = 2.2;  // [m]; [rad/s]: half a degree from frame to frame

double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * kPi * random.uniform());
}

// A mill that throws many of its balls.
Config mill() {
  Config c;
  c.mill.diameter = 0.55;
  c.mill.speed = 0.8;
  c.mill.lifters.count = 12;
  c.mill.lifters.profile = LifterProfile::kRectangle;
  c.mill.lifters.height = c.mill.lifters.width = 0.022;
  c.charge.count = 90;
  c.charge.balls = {{0.011, 0.0435, 1}};
  c.contact.wall.restitution = 0.4;
  c.run.spin_up = 1;
  c.run.revolutions = 9;
  c.run.frames_per_second = 250;
  return c;
}

std::vector<SeenFrame> frames_of(const Config& config) {
  std::vector<SeenFrame> frames;
  sim::RunSink sink;
  sink.frame = [&](const Frame& f) {
    SeenFrame seen{f.time, f.mill_angle, {}};
    for (std::size_t i = 0; i < f.x.size(); ++i)
      seen.balls.push_back({static_cast<int>(i), f.x[i], f.y[i], 0.011, f.spin[i]});
    frames.push_back(std::move(seen));
  };
  sim::simulate(config, sink);
  return frames;
}

std::vector<SeenFrame> with_noise(std::vector<SeenFrame> frames) {
  Random random(5);
  for (SeenFrame& f : frames)
    for (Sighting& s : f.balls) {
      s.x += kNoise * normal(random);
      s.y += kNoise * normal(random);
      s.spin += kSpinNoise * normal(random);
    }
  return frames;
}

ContactLaws watched(const std::vector<SeenFrame>& frames, const Config& model) {
  ContactLaws laws(model);
  for (const SeenFrame& f : frames) laws.add(f.time, f.mill_angle, f.balls);
  return laws;
}

const MeasuredLaw& law_named(const std::vector<MeasuredLaw>& laws, const std::string& name) {
  for (const MeasuredLaw& l : laws)
    if (l.name == name) return l;
  throw std::logic_error(name);
}

std::vector<SeenFrame> seen_by(const Observer& o, std::vector<SeenFrame> frames) {
  const double c = std::cos(o.rotation) * (1 + o.scale), s = std::sin(o.rotation) * (1 + o.scale);
  for (SeenFrame& f : frames) {
    f.time *= 1 + o.clock;
    f.mill_angle += o.rotation;
    for (Sighting& b : f.balls) {
      const double x = c * b.x - s * b.y;
      b.y = s * b.x + c * b.y;
      b.x = x;
      b.spin /= 1 + o.clock;
    }
  }
  return frames;
}

// Nothing hidden: no law contradicts the model, noise moves no number, and an observer who errs is foreseen.
TEST(ContactLaws, OfTheModelItselfAreTheModels) {
  const std::vector<SeenFrame> exact = frames_of(mill()), frames = with_noise(exact);
  const ContactLaws noisy = watched(frames, mill()), clean = watched(exact, mill());
  int known = 0;
  for (const MeasuredLaw& law : noisy.laws()) {
    EXPECT_FALSE(law.says.empty());
    if (law.freedom == 0) continue;
    ++known;
    EXPECT_LT(law.z, 3.5) << law.name << ": " << law.says;
  }
  EXPECT_GE(known, 6);
  const LawNumbers a = noisy.numbers(), b = clean.numbers();
  ASSERT_EQ(a.value.size(), kLawNumbers);
  for (std::size_t i = 0; i < kLawNumbers; ++i) {
    if (std::isnan(a.value[i]) || std::isnan(b.value[i])) continue;
    EXPECT_LT(std::abs(a.value[i] - b.value[i]), 4 * a.se[i] + 0.005) << name_of_law_number(i);
  }
  const Config model = mill();
  const SeenExperiment all[] = {{&noisy.events(), &model}};
  EXPECT_TRUE(found_laws(all).empty());

  const Observer wrong{0.01, 1 * kPi / 180, -0.01};
  const LawNumbers foreseen = noisy.numbers(wrong), seen = watched(seen_by(wrong, frames), mill()).numbers();
  for (std::size_t i = 0; i < kLawNumbers; ++i) {
    if (std::isnan(foreseen.value[i]) || std::isnan(seen.value[i])) continue;
    EXPECT_LT(std::abs(foreseen.value[i] - seen.value[i]), 1.5 * foreseen.se[i] + 0.001) << name_of_law_number(i);
  }
  EXPECT_GT(std::abs(foreseen.value[3] - a.value[3]), 3 * a.se[3]) << "gravity looks turned and drags";
}

// What is hidden shows in its own law, with its own size, and comes back as a table that says the same.
TEST(ContactLaws, ShowWhatTheModelLacks) {
  Config truth = mill();
  const double viscosity = 0.088;
  truth.effects["fluid_drag"]["viscosity"] = {viscosity};
  truth.effects["impact_restitution"]["drop"] = {0.4};
  truth.effects["rolling_resistance"]["coefficient"] = {0.05};
  const Config model = mill();
  const ContactLaws seen = watched(with_noise(frames_of(truth)), model);
  const std::vector<MeasuredLaw> laws = seen.laws();
  const MeasuredLaw &drag = law_named(laws, "drag"), &rebound = law_named(laws, "restitution, ball on ball"),
                    &rolling = law_named(laws, "rolling couple, ball on ball");
  EXPECT_GT(drag.z, 8);
  EXPECT_GT(rebound.z, 8);
  EXPECT_GT(rolling.z, 5);
  EXPECT_GT(law_named(laws, "spin decay").z, 5);
  EXPECT_FALSE(law_named(laws, "friction, ball on ball").z > 3.5);
  const double rate = 6 * kPi * viscosity * 0.011 / 0.0435;
  EXPECT_NEAR(drag.parameters[0].value, rate, 4 * drag.parameters[0].se + 0.01 * rate);
  EXPECT_NEAR(rolling.parameters[0].value, 0.05, 4 * rolling.parameters[0].se + 0.005);
  // The model that has it all agrees.
  for (const MeasuredLaw& law : watched(with_noise(frames_of(truth)), truth).laws())
    EXPECT_FALSE(law.z > 3.5) << law.name << ": " << law.says;

  const std::vector<std::string> tables = tabulated_sets(laws, model);
  ASSERT_GE(tables.size(), 4u);
  EXPECT_EQ(tables[0].substr(0, 37), "effects.tabulated_restitution.speed=[");
  EXPECT_EQ(tables[1].substr(0, 43), "effects.tabulated_restitution.restitution=[");
  EXPECT_EQ(tables.back().substr(0, 36), "effects.tabulated_drag.coefficient=[");
  EXPECT_NEAR(std::stod(tables.back().substr(36)), 6 * kPi * viscosity * 0.011, 0.01);  // the slowest are least sure

  const SeenExperiment all[] = {{&seen.events(), &model}};
  bool braked = false;
  for (const FoundLaw& f : found_laws(all)) {
    if (f.of != "acceleration in flight" || f.term != "v") continue;
    braked = true;
    EXPECT_NEAR(f.coefficient, -rate, 4 * f.se + 0.02 * rate);
    ASSERT_EQ(f.sets.size(), 3u);
    EXPECT_EQ(f.sets[0].substr(0, 30), "effects.tabulated_drag.speed=[");
  }
  EXPECT_TRUE(braked);
}

// A force that no effect of the registry has: balls that spin are driven sideways (Magnus), a = C w z x v.
TEST(ContactLaws, FindATermThatNoEffectHas) {
  const double c = 0.02, dt = 0.004;
  Config model = mill();
  model.mill.diameter = 4;
  model.mill.lifters = {};
  model.charge.count = 20;
  Random random(3);
  ContactLaws laws(model);
  struct Ball {
    double x, y, vx, vy, spin;
  };
  std::vector<Ball> balls(20);
  for (int frame = 0; frame < 1500; ++frame) {
    std::vector<Sighting> seen;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      Ball& b = balls[i];
      const auto number = static_cast<int>(i);
      // Thrown afresh every 100 ms; who is thrown is not seen for a moment.
      if (frame % 30 == 0)
        b = {0.15 * number - 1.4, 0, random.uniform(-0.5, 0.5), random.uniform(-1, 1), random.uniform(-60, 60)};
      if (frame % 30 > 1)
        seen.push_back({number, b.x + kNoise * normal(random), b.y + kNoise * normal(random), 0.011, b.spin});
      for (int k = 0; k < 8; ++k) {
        const double h = dt / 8, ax = -c * b.spin * b.vy, ay = c * b.spin * b.vx - kGravity;
        b.x += h * (b.vx + 0.5 * h * ax);
        b.y += h * (b.vy + 0.5 * h * ay);
        b.vx += h * ax;
        b.vy += h * ay;
      }
    }
    laws.add(frame * dt, 0, seen);
  }
  const SeenExperiment all[] = {{&laws.events(), &model}};
  const std::vector<FoundLaw> found = found_laws(all);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].term, "spin z x v");
  EXPECT_NEAR(found[0].coefficient, c, 4 * found[0].se + 0.01 * c);
  EXPECT_GE(found[0].inclusion, 0.9);
  EXPECT_LT(found[0].f_test_p, 1e-4);
  EXPECT_TRUE(found[0].sets.empty()) << "no table says this";
}

}  // namespace
}  // namespace tumble::diagnose
