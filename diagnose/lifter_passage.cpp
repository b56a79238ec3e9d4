#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "diagnose/sampled.h"

// Torque over a lifter's passage: the mean over all passages at the same place of the lifters, which are the only clock
// that two runs have in common. No frame is compared with a frame.
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

std::vector<SampledDifference> compare_lifter_passages(const ChargeMotion& a, const ChargeMotion& b) {
  if (a.lifter_count != b.lifter_count) return {};
  const Passages pa = passages_of(a), pb = passages_of(b);
  const int places = std::min(kMostPlaces, static_cast<int>(std::min(pa.per_passage, pb.per_passage)));
  if (places < kFewestPlaces) return {};
  SampledDifference d{.name = "torque_over_lifter_passage",
                      .unit = "N m",
                      .x_name = "a lifter's angle past 3 o'clock",
                      .x_unit = "deg"};
  const std::vector<Estimate> ma = means_of(pa, places), mb = means_of(pb, places);
  for (int k = 0; k < places; ++k) {
    const auto i = static_cast<std::size_t>(k);
    d.x.push_back((k + 0.5) * pa.pitch_deg / places);
    d.a.push_back(ma[i].value);
    d.a_se.push_back(ma[i].se);
    d.b.push_back(mb[i].value);
    d.b_se.push_back(mb[i].se);
  }
  judge(d, {});
  return {d};
}

}  // namespace tumble::diagnose
