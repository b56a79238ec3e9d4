#pragma once
#include <array>
#include <cmath>
#include <string>
#include <vector>

// What is summed up while a mill runs: the drive's work, where the energy goes, and impacts by what they lose.
namespace tumble::sim {

enum class Cause { kBallBallNormal, kBallBallSliding, kBallWallNormal, kBallWallSliding, kCount };
inline constexpr std::size_t kCauses = static_cast<std::size_t>(Cause::kCount);

inline std::vector<std::string> dissipation_causes() {
  return {"ball_ball_normal", "ball_ball_sliding", "ball_wall_normal", "ball_wall_sliding"};
}

// The same bins for every run, so that spectra of different mills can be laid over each other.
inline constexpr int kBinsPerDecade = 8;
inline constexpr int kLowestDecade = -9;  // [J]
inline constexpr int kHighestDecade = 3;
inline constexpr int kBins = kBinsPerDecade * (kHighestDecade - kLowestDecade);

struct Impacts {
  std::array<double, kBins> ball_ball{}, ball_wall{};  // number
};

inline int spectrum_bin(double lost) {
  if (!(lost > 0)) return 0;
  const double bin = std::floor((std::log10(lost) - kLowestDecade) * kBinsPerDecade);
  return bin < 0 ? 0 : bin >= kBins ? kBins - 1 : static_cast<int>(bin);
}

struct Ledger {
  double drive_work = 0;                     // since the start [J]
  std::array<double, kCauses> dissipated{};  // since the start [J]
  Impacts impacts;                           // since the averaging began
  bool counting_impacts = false;

  // Sums over the steps since they were last set to zero.
  double torque = 0, torque_shear = 0, mass_moment = 0;  // [N m], [N m], sum of m x [kg m]
  long steps = 0;
};

}  // namespace tumble::sim
