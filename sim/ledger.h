#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

// What is summed up while a mill runs: the drive's work, where the energy goes, impacts by what they lose and where,
// and falls by their height.
namespace tumble::sim {

enum class Cause {
  kBallBallNormal,
  kBallBallSliding,
  kBallWallNormal,
  kBallWallSliding,
  kRolling,
  kFluidDrag,
  kSlurryPool,
  kEndWalls,
  kCount
};
inline constexpr std::size_t kCauses = static_cast<std::size_t>(Cause::kCount);
inline constexpr std::size_t kPlainCauses = 4;  // those that every run has come first
inline constexpr std::array<const char*, kCauses> kCauseNames{
    "ball_ball_normal", "ball_ball_sliding", "ball_wall_normal", "ball_wall_sliding",
    "rolling",          "fluid_drag",        "slurry_pool",      "end_walls"};

// The same bins for every run, so that spectra of different mills can be laid over each other.
inline constexpr int kBinsPerDecade = 8;
inline constexpr int kLowestDecade = -9;  // [J]
inline constexpr int kHighestDecade = 3;
inline constexpr int kBins = kBinsPerDecade * (kHighestDecade - kLowestDecade);

// Lower ends of the bins [J].
inline const std::array<double, kBins> kBinEdges = [] {
  std::array<double, kBins> edges{};
  for (int k = 0; k < kBins; ++k)
    edges[static_cast<std::size_t>(k)] = std::pow(10.0, kLowestDecade + double(k) / kBinsPerDecade);
  return edges;
}();

// What is less or more than all bins goes into the first and the last one. An impact asks three times: the power of two
// tells nearly enough without a logarithm.
inline int spectrum_bin(double lost) {
  if (!(lost >= kBinEdges[0])) return 0;
  if (lost >= kBinEdges[kBins - 1]) return kBins - 1;
  constexpr double kBinsPerOctave = 0.30102999566398120 * kBinsPerDecade;
  const int octave = static_cast<int>(std::bit_cast<std::uint64_t>(lost) >> 52) - 1023;
  int bin = std::max(0, static_cast<int>(octave * kBinsPerOctave - kLowestDecade * kBinsPerDecade - 0.5));
  while (lost >= kBinEdges[static_cast<std::size_t>(bin + 1)]) ++bin;
  return bin;
}

// Impacts of one kind: number by all the energy lost from first touch to parting, by the normal and by the tangential
// part of it alone.
struct Spectrum {
  std::array<double, kBins> total{}, normal{}, tangential{};
  void add(double normal_lost, double sliding_lost) {
    total[spectrum_bin(normal_lost + sliding_lost)] += 1;
    normal[spectrum_bin(normal_lost)] += 1;
    tangential[spectrum_bin(sliding_lost)] += 1;
  }
};

// Where on the shell: a place is a face of the lifters (sim/shell.h) and an angle in the lab.
inline constexpr int kAngleBins = 72;  // of 5 degrees, counter-clockwise from 3 o'clock
inline constexpr int kFaces = 4;
inline constexpr int kPlaces = kFaces * kAngleBins;
inline constexpr int kFallBins = 64;  // of the shell's diameter

struct Impacts {
  Spectrum ball_ball, ball_wall;
  std::array<double, kPlaces> wall_number{}, wall_energy{};  // at face x kAngleBins + angle bin; energy [J]
  std::vector<double> lifter_number, lifter_energy;          // by lifter, its own faces only; energy [J]
  std::array<double, kFallBins> falls{};                     // number of flights by the height fallen
};

struct Ledger {
  double drive_work = 0;                     // since the start [J]
  std::array<double, kCauses> dissipated{};  // since the start [J]
  Impacts impacts;                           // since the averaging began
  bool counting_impacts = false;

  // Sums over the steps since they were last set to zero.
  double torque = 0, torque_shear = 0, torque_external = 0;  // [N m]
  double mass_moment = 0;                                    // sum of m x [kg m]
  long steps = 0;
};

}  // namespace tumble::sim
