#include "diagnose/library.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "analysis/charge_motion.h"
#include "core/error.h"
#include "core/experiments.h"
#include "core/mill_shape.h"
#include "core/motion_quantities.h"
#include "core/random.h"
#include "core/units.h"
#include "diagnose/contact_laws.h"
#include "diagnose/design.h"
#include "diagnose/free_flight.h"
#include "sim/simulator.h"

namespace tumble::diagnose {
namespace {

constexpr double kWidest = 2.3;     // standard deviations of what is uncertain, both ways
constexpr double kRate = 250;       // frames per second of the simulations: the shortest span is one frame
constexpr std::size_t kStride = 2;  // one frame after another shows little that is new, at twice the cost
constexpr double kRevolutions = 8;  // of a run that are looked at
constexpr std::size_t kPlain = 12, kOfSuspect = 5, kOfContact = 10;  // runs of a block

// Who watches a mill takes it for the one that MILL.toml and the experiment describe, worn or overfilled as it may be.
RunSetup as_believed(RunSetup setup, const Config& condition) {
  setup.config = condition;
  return setup;
}

// All that is summed up of a run.
class Watcher {
 public:
  Watcher(const RunSetup& setup, const Config& condition, Watched watched)
      : setup_(as_believed(setup, condition)),
        shape_(make_mill_shape(condition)),
        layout_(shape_.lifter_count),
        measurer_(setup_),
        laws_(condition) {
    double mean = 0;
    for (const double r : setup.balls.radius) mean += r / double(setup.balls.size());
    all_.push_back({});
    if (watched == Watched::kAll)
      for (const Observer& o : observers()) all_.push_back(o);
    std::vector<View> views;
    for (const Observer& o : all_)
      for (const double span : kSpans) views.push_back({span, o});
    maps_.emplace(layout_, shape_.radius, shape_.tip_radius, mean, views, kStride);
    flights_.emplace(shape_.tip_radius);
  }

  void add(const Frame& frame) {
    measurer_.add(frame);
    std::vector<Sighting> balls(frame.x.size());
    for (std::size_t i = 0; i < balls.size(); ++i)
      balls[i] = {static_cast<int>(i), frame.x[i], frame.y[i], setup_.balls.radius[i], frame.spin[i]};
    flights_->add(frame.time, balls);
    laws_.add(frame.time, frame.mill_angle, balls);
    for (std::size_t i = 0; i < balls.size(); ++i) height_ += setup_.balls.mass[i] * frame.y[i];
    maps_->add(frame.time, frame.mill_angle, std::move(balls));
    angle_ = frame.mill_angle - (frames_ == 0 ? (first_ = frame.mill_angle) : first_);
    ++frames_;
  }

  void finish(SignatureRun& run) {
    const ChargeMotion motion = measurer_.finish();
    const auto sights = finish_sights(motion);
    run.seen = sights[0];
    std::copy(sights.begin() + 1, sights.end(), run.misseen.begin());
    run.revolutions = std::abs(angle_) / (2 * kPi);
  }

 private:
  std::vector<Sight> finish_sights(const ChargeMotion& motion) {
    double mass = 0;
    for (const double m : setup_.balls.mass) mass += m;
    const double believed = slice_mass(setup_.config, class_counts(setup_.config));
    const double across = believed * kGravity * height_ / (mass * double(frames_));
    std::vector<Sight> sights;
    for (std::size_t o = 0; o < all_.size(); ++o) {
      Sight sight;
      const LawNumbers laws = laws_.numbers(all_[o]);
      for (std::size_t s = 0; s < kSpans.size(); ++s) {
        Observation& seen = sight.by_span[s];
        maps_->finish(o * kSpans.size() + s, seen);
        flights_->finish(layout_, all_[o], seen);
        seen.value[layout_.first(Observable::kTorque)] = motion.torque.value;
        const double held =
            (1 + all_[o].scale) * (std::cos(all_[o].rotation) * motion.torque_closure.value * believed / mass -
                                   std::sin(all_[o].rotation) * across);
        seen.value[layout_.first(Observable::kClosure)] = motion.torque.value - held;
        std::copy(laws.value.begin(), laws.value.end(),
                  seen.value.begin() + static_cast<std::ptrdiff_t>(layout_.first(Observable::kLaws)));
        const double turned = all_[o].rotation * 180 / kPi;
        for (std::size_t k = 2; k < kScalarData.size(); ++k)
          seen.value[layout_.first(Observable::kAngles) + k - 2] = angle_of(motion, kScalarData[k].name) + turned;
      }
      sights.push_back(std::move(sight));
    }
    return sights;
  }

  static double angle_of(const ChargeMotion& motion, const std::string& name) {
    for (const MotionQuantity& q : kMotionQuantities)
      if (name == q.name) return (motion.*q.of).value;
    return kNotGiven;
  }

  RunSetup setup_;
  MillShape shape_;
  ObservationLayout layout_;
  analysis::MeansMeasurer measurer_;
  ContactLaws laws_;
  std::vector<Observer> all_;    // first the one who does not err
  std::optional<MapSums> maps_;  // views by observer, then span
  std::optional<FreeFlights> flights_;
  double first_ = 0, angle_ = 0, height_ = 0;  // height_: sums of mass times y
  std::size_t frames_ = 0;
};

}  // namespace

std::array<Observer, kObservers> observers() {
  std::array<Observer, kObservers> list;
  std::size_t at = 0;
  for (const Suspect& suspect : suspects_of({})) {
    const Observer& o = suspect.observer;
    if (o.scale == 0 && o.rotation == 0 && o.clock == 0) continue;
    for (const double s : {-kObserved, kObserved}) list[at++] = {s * o.scale, s * o.rotation, s * o.clock};
  }
  return list;
}

SignatureRun run_signature(const Config& wanted, const Config& condition, const Progress& progress, Watched watched) {
  SignatureRun run;
  Config config = bare(wanted);
  config.run.seed = wanted.run.seed;
  std::unique_ptr<Watcher> watcher;
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& setup) { watcher = std::make_unique<Watcher>(setup, condition, watched); };
  sink.frame = [&](const Frame& frame) { watcher->add(frame); };
  sink.progress = progress;
  try {
    sim::simulate(config, sink);
    watcher->finish(run);
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& e) {
    run.error = e.what();
  }
  return run;
}

Config bare(Config condition) {
  condition.run.seed = 1;
  condition.run.frames_per_second = kRate;
  condition.run.revolutions = kRevolutions;
  condition.measurement = {};
  condition.origin.clear();
  condition.file.clear();
  return condition;
}

std::vector<SignatureAsked> plan_block(std::size_t block, std::size_t uncertain, const std::vector<Suspect>& suspects) {
  std::vector<SignatureAsked> asked(kPlain);
  for (std::size_t s = 0; s < suspects.size(); ++s) {
    const Suspect& suspect = suspects[s];
    if (!suspect.is_simulated()) continue;
    const std::size_t runs = suspect.acts_in_contacts ? kOfContact : kOfSuspect;
    for (std::size_t k = 0; k < runs; ++k) {  // strengths over all blocks, the strong ones more often: they tell more
      const double share = double(block * runs + k) * 0.6180339887498949;
      const double along = 2 * (share - std::floor(share)) - 1;  // [-1, 1)
      const bool both_ways = suspect.low < 0;
      const double far = std::sqrt(both_ways ? std::abs(along) : (along + 1) / 2);
      const double strength = suspect.low == suspect.high ? suspect.high
                              : both_ways                 ? far * (along < 0 ? suspect.low : suspect.high)
                                                          : suspect.low + far * (suspect.high - suspect.low);
      asked.push_back({{}, static_cast<int>(s), strength, 0});
    }
  }
  Random random(block + 1);
  const auto places = latin_hypercube(asked.size(), std::max<std::size_t>(1, uncertain), random);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    for (std::size_t k = 0; k < uncertain; ++k) asked[i].uncertain.push_back(kWidest * (2 * places[i][k] - 1));
    asked[i].seed = 1 + block * asked.size() + i;
  }
  return asked;
}

std::vector<float> pack(const SignatureRun& run) {
  std::vector<float> row;
  if (!run.error.empty()) return row;
  row.push_back(static_cast<float>(run.strength));
  row.push_back(static_cast<float>(run.revolutions));
  const auto add = [&](const Sight& sight) {
    for (const Observation& seen : sight.by_span)
      for (const double v : seen.value) row.push_back(static_cast<float>(v));
  };
  add(run.seen);
  for (const Sight& sight : run.misseen) add(sight);
  return row;
}

bool unpack(const std::vector<float>& row, const ObservationLayout& layout, SignatureRun& run) {
  if (row.size() != 2 + layout.size() * kSpans.size() * (1 + kObservers)) return false;
  run.strength = row[0];
  run.revolutions = row[1];
  auto at = row.begin() + 2;
  const auto take = [&](Sight& sight) {
    for (Observation& seen : sight.by_span) {
      seen.value.assign(at, at + static_cast<std::ptrdiff_t>(layout.size()));
      at += static_cast<std::ptrdiff_t>(layout.size());
    }
  };
  take(run.seen);
  for (Sight& sight : run.misseen) take(sight);
  return true;
}

}  // namespace tumble::diagnose
