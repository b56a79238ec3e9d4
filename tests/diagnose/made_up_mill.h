#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "core/random.h"
#include "diagnose/response.h"

// A made-up mill whose numbers are curved functions of two uncertain keys and of the suspects, with chance that moves
// neighbouring numbers together. Shares nothing with the response that is fitted to it but that it is smooth.
namespace tumble::diagnose {

struct Strengths {
  double bend = 0, twist = 0, scale = 0;
};

class MadeUpMill {
 public:
  static constexpr std::size_t kNumbers = 60;

  MadeUpMill() : suspects_(4) {
    suspects_[0].name = "bend";
    suspects_[0].sets.push_back({"bend", 0, 1});
    suspects_[1].name = "twist";
    suspects_[1].sets.push_back({"twist", 0, 1});
    suspects_[1].low = -1.5;
    suspects_[2].name = "camera_scale";
    suspects_[2].kind = SuspectKind::kArtefact;
    suspects_[2].low = -1.5;
    suspects_[2].observer.scale = 0.02;
    suspects_[3].name = "torque_offset";  // which nothing shows where there is no torque
    suspects_[3].kind = SuspectKind::kArtefact;
    suspects_[3].low = -1.5;
    suspects_[3].torque_offset = 0.036;

    Random random(5);
    std::vector<SignatureRun> runs;
    for (int i = 0; i < 300; ++i) {
      const int suspect = i % 3 - 1;
      const double low = suspect == 1 ? -1.5 : 0, strength = suspect < 0 ? 0 : random.uniform(low, 1.5);
      runs.push_back(run(random, {suspect == 0 ? strength : 0, suspect == 1 ? strength : 0, 0}, 0,
                         random.uniform(-2.3, 2.3), random.uniform(-2.3, 2.3)));
      runs.back().suspect = suspect;
      runs.back().strength = strength;
    }
    std::vector<const SignatureRun*> all;
    for (const SignatureRun& r : runs) all.push_back(&r);
    std::vector<std::size_t> chosen(kNumbers);
    for (std::size_t i = 0; i < kNumbers; ++i) chosen[i] = i;
    response_ = std::make_unique<Response>(all, suspects_, chosen, std::vector<double>(kNumbers, 0), kSpans[0], 0);
  }

  // `stranger`: strength of what is on nobody's list. Keys not given: as likely as they are.
  SignatureRun run(Random& random, const Strengths& s, double stranger = 0, double a = NAN, double b = NAN) const {
    SignatureRun run;
    run.uncertain = {std::isnan(a) ? gaussian(random) : a, std::isnan(b) ? gaussian(random) : b};
    run.revolutions = 8;
    std::vector<double> chance(kNumbers);
    double drift = 0;
    for (double& c : chance) c = drift = 0.6 * drift + 0.8 * gaussian(random);
    const auto seen_by = [&](double scale) {
      Observation seen;
      seen.noise.assign(kNumbers, 0);
      for (std::size_t i = 0; i < kNumbers; ++i)
        seen.value.push_back(chance[i] + law(i, run.uncertain[0], run.uncertain[1], s, s.scale + scale) +
                             stranger * std::sin(11 * double(i) / kNumbers));
      Sight sight;
      sight.by_span.fill(seen);
      return sight;
    };
    run.seen = seen_by(0);
    run.misseen[0] = seen_by(-kObserved);
    run.misseen[1] = seen_by(kObserved);
    return run;
  }

  const Response* response() const { return response_.get(); }
  const std::vector<Suspect>& suspects() const { return suspects_; }

 private:
  static double law(std::size_t i, double a, double b, const Strengths& s, double scale) {
    const double t = double(i) / kNumbers;
    return 20 * std::sin(3 * t + 0.15 * a) + 5 * std::tanh(0.15 * b) * t +
           16 * s.bend * std::exp(-t * (1 + 0.2 * s.bend)) + 8 * s.twist * std::cos(7 * t + 0.1 * a) +
           12 * scale * (1 + t * t);
  }

  std::vector<Suspect> suspects_;
  std::unique_ptr<Response> response_;
};

}  // namespace tumble::diagnose
