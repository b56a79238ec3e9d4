#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/frame.h"

// Names and places in RUN.h5 (docs/run-file.md), shared by its writer and its reader.
namespace tumble::io::run_layout {

inline constexpr int kFormat = 2;                     // grows when an older reader could not read the file
inline constexpr std::size_t kCaveatCapacity = 4096;  // [bytes]

// A dataset: the library reads past its memory where a foreign file's attributes are damaged, so nothing is read from
// them.
inline constexpr const char* kFormatPath = "parameters/run_file_format";
inline constexpr const char* kFramesWritten = "parameters/frames_written";
inline constexpr const char* kComplete = "parameters/complete";
inline constexpr const char* kCheckpointWords = "parameters/checkpoint/words";
inline constexpr const char* kCheckpointSlots = "parameters/checkpoint/slots";
inline constexpr const char* kStep = "particles/balls/position/step";
inline constexpr const char* kTime = "particles/balls/position/time";

// A number per frame.
struct Series {
  const char* path;
  const char* unit;
  double& (*of)(Frame&);
};
std::span<const Series> all_series();
inline double value(const Series& series, const Frame& frame) { return series.of(const_cast<Frame&>(frame)); }

// One or two numbers per ball and frame, kept in single precision.
struct BallArray {
  const char* path;
  const char* unit;
  std::vector<double> Frame::*first;
  std::vector<double> Frame::*second;  // nullptr for one number
  std::size_t components() const { return second ? 2 : 1; }
};
std::span<const BallArray> all_ball_arrays();

// An array of the whole run, known at its end.
struct ResultArray {
  std::string path;
  const char* unit;
  enum class Of { kBins, kLifters } numbers;
  std::vector<double>& (*of)(RunResult&);
};
std::span<const ResultArray> all_result_arrays();
std::size_t space_for(const ResultArray& array, const Config& config);  // set aside [numbers]
inline const std::vector<double>& values(const ResultArray& array, const RunResult& result) {
  return array.of(const_cast<RunResult&>(result));
}

std::string dissipation_path(const std::string& cause);

// A checkpoint's slot: the words are valid where the checksum says so. Two slots take turns, so a writer that dies in
// one leaves the other.
struct Slot {
  std::int64_t sequence = 0;  // 0: never written
  std::int64_t frames_written = 0;
  std::int64_t count = 0;     // of words
  std::int64_t checksum = 0;  // of the three above and the words
};
class Checksum {
 public:
  explicit Checksum(const Slot& slot);
  void add(std::span<const double> words);
  std::int64_t value() const { return std::bit_cast<std::int64_t>(sum_); }

 private:
  void mix(std::uint64_t word);
  std::uint64_t sum_ = 0x7475'6D62'6C65'0001ull;
};

// RUN.h5.part
std::filesystem::path part_of(const std::filesystem::path& path);

}  // namespace tumble::io::run_layout
