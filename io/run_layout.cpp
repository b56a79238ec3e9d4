#include "io/run_layout.h"

#include <algorithm>

namespace tumble::io::run_layout {
namespace {

template <auto... Members>
double& reach(Frame& frame) {
  return (frame.*....*Members);
}
template <auto Member>
constexpr auto kObserved = &reach<&Frame::observed, Member>;

template <auto... Members>
std::vector<double>& reach_array(RunResult& result) {
  return (result.*....*Members);
}
// A face's row of the impact places.
template <auto Rows, std::size_t Face>
std::vector<double>& reach_face(RunResult& result) {
  return (result.places.*Rows)[Face];
}

constexpr std::size_t kBinsSpace = 257;  // of a spectrum or a histogram, edges included
constexpr std::size_t kFewestLifterSpace = 1024;

std::vector<ResultArray> make_result_arrays() {
  using R = RunResult;
  using I = ImpactSpectrum;
  using P = ImpactPlaces;
  const std::string spectrum = "observables/impact_spectrum/", falls = "observables/fall_heights/",
                    places = "observables/impact_places/";
  constexpr auto kBins = ResultArray::Of::kBins, kLifters = ResultArray::Of::kLifters;
  std::vector<ResultArray> arrays{
      {spectrum + "edges", "J", kBins, &reach_array<&R::spectrum, &I::edges_J>},
      {spectrum + "ball_ball", "s-1", kBins, &reach_array<&R::spectrum, &I::ball_ball>},
      {spectrum + "ball_ball_normal", "s-1", kBins, &reach_array<&R::spectrum, &I::ball_ball_normal>},
      {spectrum + "ball_ball_tangential", "s-1", kBins, &reach_array<&R::spectrum, &I::ball_ball_tangential>},
      {spectrum + "ball_wall", "s-1", kBins, &reach_array<&R::spectrum, &I::ball_wall>},
      {spectrum + "ball_wall_normal", "s-1", kBins, &reach_array<&R::spectrum, &I::ball_wall_normal>},
      {spectrum + "ball_wall_tangential", "s-1", kBins, &reach_array<&R::spectrum, &I::ball_wall_tangential>},
      {falls + "edges", "m", kBins, &reach_array<&R::falls, &FallHeights::edges>},
      {falls + "frequency", "s-1", kBins, &reach_array<&R::falls, &FallHeights::frequency>},
      {places + "angle_edges", "deg", kBins, &reach_array<&R::places, &P::angle_edges_deg>},
      {places + "lifter_frequency", "s-1", kLifters, &reach_array<&R::places, &P::lifter_frequency>},
      {places + "lifter_power", "W", kLifters, &reach_array<&R::places, &P::lifter_power>},
  };
  const auto add_faces = [&]<std::size_t... Face>(std::index_sequence<Face...>) {
    (arrays.push_back({places + kFaceNames[Face] + "_frequency", "s-1", kBins, &reach_face<&P::frequency, Face>}), ...);
    (arrays.push_back({places + kFaceNames[Face] + "_power", "W", kBins, &reach_face<&P::power, Face>}), ...);
  };
  add_faces(std::make_index_sequence<kFaceNames.size()>());
  return arrays;
}

}  // namespace

std::span<const ResultArray> all_result_arrays() {
  static const std::vector<ResultArray> arrays = make_result_arrays();
  return arrays;
}

std::size_t space_for(const ResultArray& array, const Config& config) {
  if (array.numbers == ResultArray::Of::kBins) return kBinsSpace;
  return std::max(kFewestLifterSpace, static_cast<std::size_t>(std::max(0, config.mill.lifters.count)));
}

std::span<const Series> all_series() {
  using O = Observables;
  static const std::array series{
      Series{"observables/torque", "N m", kObserved<&O::torque>},
      Series{"observables/torque_shear", "N m", kObserved<&O::torque_shear>},
      Series{"observables/torque_closure", "N m", kObserved<&O::torque_closure>},
      Series{"observables/torque_external", "N m", kObserved<&O::torque_external>},
      Series{"observables/power", "W", kObserved<&O::power>},
      Series{"observables/mill_angle", "rad", &reach<&Frame::mill_angle>},
      Series{"observables/energy/kinetic", "J", kObserved<&O::kinetic>},
      Series{"observables/energy/potential", "J", kObserved<&O::potential>},
      Series{"observables/energy/elastic", "J", kObserved<&O::elastic>},
      Series{"observables/drive_work", "J", kObserved<&O::drive_work>},
      Series{"observables/locked_balls", "", kObserved<&O::locked_balls>},
  };
  return series;
}

std::span<const BallArray> all_ball_arrays() {
  static const std::array arrays{
      BallArray{"particles/balls/position", "m", &Frame::x, &Frame::y},
      BallArray{"particles/balls/velocity", "m s-1", &Frame::vx, &Frame::vy},
      BallArray{"particles/balls/angle", "rad", &Frame::angle, nullptr},
      BallArray{"particles/balls/angular_velocity", "rad s-1", &Frame::spin, nullptr},
  };
  return arrays;
}

std::string dissipation_path(const std::string& cause) { return "observables/dissipation/" + cause; }

Checksum::Checksum(const Slot& slot) {
  for (const std::int64_t v : {slot.sequence, slot.frames_written, slot.count}) mix(static_cast<std::uint64_t>(v));
}

void Checksum::add(std::span<const double> words) {
  for (const double w : words) mix(std::bit_cast<std::uint64_t>(w));
}

// Word by word, each mixed in by SplitMix64's finalizer: fast, and no single flipped or missing word goes unseen.
void Checksum::mix(std::uint64_t word) {
  std::uint64_t z = sum_ + 0x9E3779B97F4A7C15ull + word;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  sum_ = z ^ (z >> 31);
}

std::filesystem::path part_of(const std::filesystem::path& path) {
  std::filesystem::path part = path;
  part += ".part";
  return part;
}

}  // namespace tumble::io::run_layout
