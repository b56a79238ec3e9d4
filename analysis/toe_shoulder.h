#pragma once
#include <array>
#include <deque>
#include <vector>

#include "analysis/block_sums.h"
#include "analysis/ring_occupancy.h"
#include "core/charge_motion.h"

namespace tumble::analysis {

// Where occupancy first falls below these shares of the plateau (contract, section 1).
enum EdgeLevel { kHalf = 0, kBulk = 1, kOuter = 2 };
inline constexpr std::array<double, 3> kEdgeShare = {0.50, 0.75, 0.25};

struct ChargeEdges {
  std::array<double, 3> toe{kNotGiven, kNotGiven, kNotGiven};       // by EdgeLevel [degrees]
  std::array<double, 3> shoulder{kNotGiven, kNotGiven, kNotGiven};  // by EdgeLevel [degrees]
  double plateau = kNotGiven;                                       // 90th percentile of the smoothed occupancy
  double middle = kNotGiven;  // circular mean of the bins above half the plateau [degrees]
};

inline constexpr int kMeanBox = 3;  // by which a time mean is smoothed before its edges are looked for [degrees]

// Box of `width` bins (odd), circular; NaN bins are left out and stay NaN.
RingProfile smooth(const RingProfile& profile, int width);

// The contract's search on a profile that was smoothed already; between bin centres occupancy is taken as linear.
// NaN where there is no charge, no edge, or where the edge lies behind hidden bins.
ChargeEdges find_edges(const RingProfile& smoothed);

// Time mean of the ring's occupancy; a bin counts in the frames in which it is not hidden.
class RingMean {
 public:
  void add(const RingProfile& profile, const std::vector<bool>& hidden);
  RingProfile mean() const;

 private:
  RingProfile sum_{}, seen_{};
};

struct EdgeEstimates {
  std::array<Estimate, 3> toe, shoulder;  // by EdgeLevel [degrees]
  RingProfile occupancy{};                // time mean, not smoothed
  RingProfile occupancy_se{};             // by batch means; NaN where not known
};

// Time mean of the ring's occupancy, and edges with errors, from one profile a frame.
class EdgeStatistics {
 public:
  // `passage_frames`: frames in one lifter passage, the window of the running mean for per-frame values.
  explicit EdgeStatistics(double passage_frames);

  void add(const RingProfile& profile);  // NaN: hidden in this frame

  // Edges per frame: running mean over one lifter passage, 5-degree box. As many as frames were added.
  std::vector<ChargeEdges> finish_frames();

  // Edges of the time mean, 3-degree box. Errors by a block bootstrap over time (Kuensch 1989): it sees shelves and
  // jumps of the edge, which a slope alone does not.
  EdgeEstimates estimate() const;

 private:
  ChargeEdges edges_at(std::size_t frame) const;

  std::size_t half_window_;
  BlockSums sums_;                  // 360 sums of occupancy, 360 counts of frames in which the bin was seen
  std::deque<RingProfile> window_;  // the last frames, newest at the back
  std::size_t added_ = 0;
  std::vector<ChargeEdges> per_frame_;
};

}  // namespace tumble::analysis
