#include "diagnose/lifter_passage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "diagnose/sampled.h"

namespace tumble::diagnose {
namespace {

constexpr int kMostPlaces = 12, kFewestPlaces = 4;  // along a passage
constexpr std::size_t kBatches = 16;       // of the samples in order, as the fields have: passages are correlated
constexpr std::size_t kFewestBatches = 8;  // with a sample at a place, for an error

struct Sample {
  double past_deg;  // a lifter's angle past 3 o'clock, [0, pitch)
  double torque;    // [N m]
};

struct Passages {
  std::vector<Sample> samples;
  double pitch_deg = 0;    // from one lifter to the next
  double per_passage = 0;  // samples
};

Passages passages_of(const ChargeMotion& m) {
  Passages p;
  if (m.lifter_count < 1) return p;
  p.pitch_deg = 360.0 / m.lifter_count;
  double turned = 0;
  auto row = m.torque_series.begin();
  for (std::size_t i = 1; i < m.profile.size(); ++i) {
    const double since = wrap_180(m.profile[i].mill_angle_deg - m.profile[i - 1].mill_angle_deg);
    while (row != m.torque_series.end() && row->time < m.profile[i].time) ++row;
    if (row == m.torque_series.end()) break;
    if (row->time != m.profile[i].time || !std::isfinite(since)) continue;
    // The torque is the mean since the frame before.
    const double middle = m.profile[i].mill_angle_deg - 0.5 * since;
    p.samples.push_back({middle - p.pitch_deg * std::floor(middle / p.pitch_deg), row->torque});
    turned += std::abs(since);
  }
  if (turned > 0) p.per_passage = p.pitch_deg * static_cast<double>(p.samples.size()) / turned;
  return p;
}

std::vector<Estimate> means_of(const Passages& p, int places) {
  struct Sum {
    double torque = 0, count = 0;
  };
  const auto n = static_cast<std::size_t>(places);
  std::vector<std::array<Sum, kBatches>> sums(n);
  for (std::size_t i = 0; i < p.samples.size(); ++i) {
    const auto place = static_cast<std::size_t>(p.samples[i].past_deg / p.pitch_deg * places);
    Sum& sum = sums[std::min(place, n - 1)][i * kBatches / p.samples.size()];
    sum.torque += p.samples[i].torque;
    sum.count += 1;
  }
  std::vector<Estimate> means;
  for (const auto& of_place : sums) {
    std::vector<Estimate> batches;
    for (const Sum& sum : of_place)
      if (sum.count > 0) batches.push_back({sum.torque / sum.count, kNotGiven});
    means.push_back(batches.size() < kFewestBatches ? Estimate{} : mean_of_repeats(batches));
  }
  return means;
}

}  // namespace

OverPassage torque_over_passage(std::span<const ChargeMotion* const> motions) {
  std::vector<Passages> all;
  int places = kMostPlaces;
  for (const ChargeMotion* m : motions) {
    if (m->lifter_count != motions.front()->lifter_count) return {};
    all.push_back(passages_of(*m));
    places = std::min(places, static_cast<int>(all.back().per_passage));
  }
  OverPassage over;
  if (all.empty() || places < kFewestPlaces) return over;
  for (int k = 0; k < places; ++k) over.past_deg.push_back((k + 0.5) * all.front().pitch_deg / places);
  for (const Passages& p : all) over.torque.push_back(means_of(p, places));
  return over;
}

std::vector<SampledDifference> compare_lifter_passages(const ChargeMotion& a, const ChargeMotion& b) {
  OverPassage over = torque_over_passage(std::array{&a, &b});
  if (over.past_deg.empty()) return {};
  SampledDifference d{.name = "torque_over_lifter_passage",
                      .unit = "N m",
                      .x_name = "a lifter's angle past 3 o'clock",
                      .x_unit = "deg",
                      .x = std::move(over.past_deg)};
  for (std::size_t k = 0; k < d.x.size(); ++k) {
    d.a.push_back(over.torque[0][k].value);
    d.a_se.push_back(over.torque[0][k].se);
    d.b.push_back(over.torque[1][k].value);
    d.b_se.push_back(over.torque[1][k].se);
  }
  judge(d, {});
  return {d};
}

}  // namespace tumble::diagnose
