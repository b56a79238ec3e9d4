#include "diagnose/contact_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/effects.h"
#include "core/units.h"
#include "diagnose/law_samples.h"

namespace tumble::diagnose {
namespace {

struct LawKind {
  Law law;
  const char *name, *x_name, *x_unit, *y_name, *y_unit;
  std::vector<double> edges;  // of x, in units of `unit_of`
  double finest;              // what the model's own time step blurs y by
  std::vector<std::string> speaks_for;
};

const std::array kKinds{
    LawKind{Law::kDrag,
            "drag",
            "speed",
            "m/s",
            "deceleration",
            "m/s2",
            {0.05, 0.25, 0.5, 0.8, 9},
            0.002,
            {"fluid_drag", "end_wall_friction", "slurry_pool"}},
    LawKind{Law::kLift,
            "lift",
            "height over the axis",
            "R",
            "upward acceleration beside gravity",
            "m/s2",
            {-1, -0.45, 0.1, 1},
            0.002,
            {"slurry_pool", "camera_rotation", "frame_clock", "camera_scale"}},
    LawKind{Law::kEnds,
            "end friction",
            "slip against the ends",
            "m/s",
            "deceleration against the ends",
            "m/s2",
            {0.05, 9},
            0.002,
            {"end_wall_friction", "fluid_drag"}},
    LawKind{Law::kSpinDecay,
            "spin decay",
            "spin",
            "rad/s",
            "share of the spin lost in flight",
            "1/s",
            {0.03, 9},
            0.02,
            {"fluid_drag", "slurry_pool"}},
    LawKind{Law::kBallRestitution,
            "restitution, ball on ball",
            "normal impact speed",
            "m/s",
            "restitution",
            "",
            {0.08, 0.16, 0.26, 9},
            0.003,
            {"impact_restitution"}},
    LawKind{Law::kWallRestitution,
            "restitution, ball on wall",
            "normal impact speed",
            "m/s",
            "restitution",
            "",
            {0.16, 0.6, 9},
            0.003,
            {"impact_restitution"}},
    LawKind{Law::kBallFriction,
            "friction, ball on ball",
            "mean slip of the impact",
            "m/s",
            "friction coefficient",
            "",
            {0.04, 0.17, 9},
            0.002,
            {"friction_weakening"}},
    LawKind{Law::kWallFriction,
            "friction, ball on wall",
            "mean slip of the impact",
            "m/s",
            "friction coefficient",
            "",
            {0.04, 9},
            0.002,
            {"wall_friction", "friction_weakening"}},
    LawKind{Law::kRolling,
            "rolling couple, ball on ball",
            "relative spin",
            "rad/s",
            "couple over normal impulse and effective radius",
            "",
            {0.03, 0.12, 9},
            0.0005,
            {"rolling_resistance"}},
};

// Squared error of the ratio y of the sums: of each event what it and all others without it disagree by (the jackknife,
// which knows that few events with much weight scatter more). `total`: the sum below.
double variance_of(const std::vector<LawSample>& samples, const std::vector<std::size_t>& in, double y, double total) {
  double sum = 0, residual = 0, weight = 0;
  const auto end_event = [&] {
    const double disagreement = residual / (total - weight);
    sum += disagreement * disagreement;
    residual = weight = 0;
  };
  for (std::size_t k = 0; k < in.size(); ++k) {
    const LawSample& s = samples[in[k]];
    if (k > 0 && samples[in[k - 1]].event != s.event) end_event();
    residual += s.up - y * s.down;
    weight += s.down;
  }
  end_event();
  return sum;
}

struct LawBin {
  double x = kNotGiven, y = kNotGiven, se = kNotGiven, model = kNotGiven;
  int count = 0;
};

// Events in a bin: for its own error to be one, and for a number whose scatter is known from elsewhere.
constexpr int kLeastOfLaw = 12, kLeastOfNumber = 4;

std::vector<LawBin> bins_of(const std::vector<LawSample>& samples, const LawKind& kind, double unit, int least) {
  std::vector<LawBin> bins;
  for (std::size_t b = 0; b + 1 < kind.edges.size(); ++b) {
    std::vector<std::size_t> in;
    for (std::size_t k = 0; k < samples.size(); ++k)
      if (samples[k].key >= kind.edges[b] * unit && samples[k].key < kind.edges[b + 1] * unit) in.push_back(k);
    double up = 0, down = 0, x = 0, model = 0;
    LawBin bin;
    for (std::size_t k = 0; k < in.size(); ++k) {
      const LawSample& s = samples[in[k]];
      up += s.up;
      down += s.down;
      x += s.x * s.down;
      model += s.model;
      bin.count += k == 0 || samples[in[k - 1]].event != s.event;
    }
    if (bin.count >= least) {
      bin.x = x / down;
      bin.y = up / down;
      bin.model = model / down;
      bin.se = std::sqrt(variance_of(samples, in, bin.y, down));
    }
    bins.push_back(bin);
  }
  return bins;
}

// What x is measured in: the speed of a fall through the mill, radii, the spin of a ball that rolls at that speed.
double unit_of(const LawKind& kind, const Config& config) {
  if (kind.law == Law::kLift) return 1;
  const double speed = std::sqrt(kGravity * config.mill.diameter);
  return kind.law == Law::kRolling || kind.law == Law::kSpinDecay ? speed / mean_radius(config.charge.balls) : speed;
}

// Wilson & Hilferty (1931): the cube root of a chi-square over its freedom is nearly normal.
double deviate_of_chi2(double chi2, double freedom) {
  const double v = 2 / (9 * freedom);
  return (std::cbrt(chi2 / freedom) - (1 - v)) / std::sqrt(v);
}

// y = a f(x) + b g(x) by the bins' errors; b with its error, and what the model's bins give.
struct Line {
  double a = kNotGiven, b = kNotGiven, a_se = kNotGiven, b_se = kNotGiven;
};
template <class F, class G>
Line line_of(const std::vector<LawBin>& bins, double LawBin::*y, const F& f, const G& g) {
  double ff = 0, fg = 0, gg = 0, fy = 0, gy = 0;
  for (const LawBin& b : bins) {
    if (std::isnan(b.y)) continue;
    const double w = 1 / (b.se * b.se), at_f = f(b.x), at_g = g(b.x);
    ff += w * at_f * at_f;
    fg += w * at_f * at_g;
    gg += w * at_g * at_g;
    fy += w * at_f * b.*y;
    gy += w * at_g * b.*y;
  }
  const double d = ff * gg - fg * fg;
  return {(gg * fy - fg * gy) / d, (ff * gy - fg * fy) / d, std::sqrt(gg / d), std::sqrt(ff / d)};
}
template <class F>
LawParameter parameter_of(const char* name, const char* unit, const std::vector<LawBin>& bins, const F& f) {
  double ff = 0, fy = 0, fm = 0;
  for (const LawBin& b : bins) {
    if (std::isnan(b.y)) continue;
    const double w = f(b.x) / (b.se * b.se);
    ff += w * f(b.x);
    fy += w * b.y;
    fm += w * b.model;
  }
  return {name, unit, fy / ff, 1 / std::sqrt(ff), fm / ff};
}

std::vector<LawParameter> parameters_of(const LawKind& kind, const std::vector<LawBin>& bins, const Config& config) {
  const auto known = std::count_if(bins.begin(), bins.end(), [](const LawBin& b) { return std::isfinite(b.y); });
  const auto constant = [](double) { return 1.0; };
  if (known == 0) return {};
  switch (kind.law) {
    case Law::kDrag:
      return {parameter_of("rate", "1/s", bins, [](double v) { return v; })};
    case Law::kLift:
      return {parameter_of("mean", "m/s2", bins, constant)};
    case Law::kSpinDecay:
      return {parameter_of("rate", "1/s", bins, constant)};
    case Law::kEnds:
      return {parameter_of("coefficient", "", bins, [](double) { return kGravity; })};
    case Law::kBallRestitution:
    case Law::kWallRestitution: {
      std::vector<LawParameter> all{parameter_of("restitution", "", bins, constant)};
      if (known < 3) return all;
      const double v_e = effect_value(config, "impact_restitution", "impact_speed");
      const auto lost = [&](double v) { return -(1 - std::exp(-v / v_e)); };
      const Line seen = line_of(bins, &LawBin::y, constant, lost), own = line_of(bins, &LawBin::model, constant, lost);
      all.push_back({"drop", "", seen.b / seen.a, seen.b_se / seen.a, own.b / own.a});
      return all;
    }
    case Law::kBallFriction:
    case Law::kWallFriction:
      return {parameter_of("friction", "", bins, constant)};
    case Law::kRolling:
      break;
  }
  return {parameter_of("coefficient", "", bins, constant)};
}

std::string sentence(const LawKind& kind, const MeasuredLaw& law, std::size_t asked) {
  if (law.x.empty()) return fmt::format("Too little is seen of {}.", kind.name);
  std::size_t worst = 0;
  for (std::size_t k = 1; k < law.x.size(); ++k)
    if (std::abs(law.y[k] - law.model[k]) / law.se[k] > std::abs(law.y[worst] - law.model[worst]) / law.se[worst])
      worst = k;
  const std::string unit = law.y_unit.empty() ? "" : " " + law.y_unit;
  const std::string x_unit = law.x_unit.empty() ? "" : " " + law.x_unit;
  std::string says =
      fmt::format("{} is {:.3g} ± {:.2g}{} at {} {:.2g}{}, the model's is {:.3g}{}.", kind.y_name, law.y[worst],
                  law.se[worst], unit, kind.x_name, law.x[worst], x_unit, law.model[worst], unit);
  says[0] = static_cast<char>(std::toupper(says[0]));
  if (law.x.size() < asked) says += fmt::format(" {} of {} ranges hold too little.", asked - law.x.size(), asked);
  return says;
}

}  // namespace

ContactLaws::ContactLaws(const Config& model) : config_(model), model_(model), events_(model) {}

std::vector<MeasuredLaw> ContactLaws::laws() const {
  std::vector<MeasuredLaw> all;
  const std::vector<FlightWindow> flights = events_.flights();
  const std::vector<SeenImpact> impacts = events_.impacts();
  for (const LawKind& kind : kKinds) {
    std::vector<LawBin> bins = bins_of(samples_of(kind.law, flights, impacts, config_, &model_, {}), kind,
                                       unit_of(kind, config_), kLeastOfLaw);
    MeasuredLaw law{.name = kind.name,
                    .x_name = kind.x_name,
                    .x_unit = kind.x_unit,
                    .y_name = kind.y_name,
                    .y_unit = kind.y_unit,
                    .speaks_for = kind.speaks_for};
    double chi2 = 0;
    for (LawBin& b : bins) {
      if (std::isnan(b.y)) continue;
      b.se = std::hypot(b.se, kind.finest);
      law.x.push_back(b.x);
      law.y.push_back(b.y);
      law.se.push_back(b.se);
      law.model.push_back(b.model);
      law.count.push_back(b.count);
      chi2 += (b.y - b.model) * (b.y - b.model) / (b.se * b.se);
    }
    law.freedom = double(law.x.size());
    if (law.freedom > 0) law.z = deviate_of_chi2(chi2, law.freedom);
    law.parameters = parameters_of(kind, bins, config_);
    law.says = sentence(kind, law, bins.size());
    all.push_back(std::move(law));
  }
  return all;
}

LawNumbers ContactLaws::numbers(const Observer& observer) const {
  LawNumbers n;
  const std::vector<FlightWindow> flights = events_.flights();
  const std::vector<SeenImpact> impacts = events_.impacts();
  for (const LawKind& kind : kKinds)
    for (const LawBin& b : bins_of(samples_of(kind.law, flights, impacts, config_, nullptr, observer), kind,
                                   unit_of(kind, config_), kLeastOfNumber)) {
      n.value.push_back(b.y);
      n.se.push_back(b.se);
    }
  return n;
}

const char* name_of_law_number(std::size_t i) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const LawKind& kind : kKinds)
      for (std::size_t b = 1; b < kind.edges.size(); ++b) all.push_back(fmt::format("{}, {}", kind.name, b));
    return all;
  }();
  return names.at(i).c_str();
}

std::vector<MeasuredLaw> measured_laws(std::span<const SeenFrame> frames, const Config& model) {
  ContactLaws laws(model);
  for (const SeenFrame& f : frames) laws.add(f.time, f.mill_angle, f.balls);
  return laws.laws();
}

}  // namespace tumble::diagnose
