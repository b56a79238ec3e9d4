#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

// All that a simulation needs to go on bit-identically, as words that are the simulator's own affair. They pass a piece
// at a time: all at once they would take as much memory as the run itself.
namespace tumble {

using TakeWords = std::function<void(std::span<const double>)>;

// As a simulation gives it: `tell` hands over all words in order, for as long as the call lasts that brought it.
struct Checkpoint {
  std::int64_t frames_written = 0;
  std::size_t size = 0;  // words
  std::function<void(const TakeWords&)> tell;
};

// As it is given back: `next` fills the span with the words that follow.
struct StoredCheckpoint {
  std::int64_t frames_written = 0;
  std::size_t size = 0;
  std::function<void(std::span<double>)> next;
};

}  // namespace tumble
