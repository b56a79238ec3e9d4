#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/checkpoint.h"

// Checkpoints in memory, whole.
namespace tumble {

struct KeptCheckpoint {
  std::int64_t frames_written = 0;
  std::vector<double> words;
};

inline KeptCheckpoint keep(const Checkpoint& checkpoint) {
  KeptCheckpoint kept{checkpoint.frames_written, {}};
  checkpoint.tell(
      [&](std::span<const double> piece) { kept.words.insert(kept.words.end(), piece.begin(), piece.end()); });
  return kept;
}

inline KeptCheckpoint keep(const StoredCheckpoint& stored) {
  KeptCheckpoint kept{stored.frames_written, std::vector<double>(stored.size)};
  stored.next(kept.words);
  return kept;
}

inline Checkpoint told(const KeptCheckpoint& kept) {
  return {kept.frames_written, kept.words.size(), [kept](const TakeWords& take) {
            const auto half = static_cast<std::ptrdiff_t>(kept.words.size() / 2);
            take({kept.words.begin(), kept.words.begin() + half});
            take({kept.words.begin() + half, kept.words.end()});
          }};
}

inline StoredCheckpoint stored(const KeptCheckpoint& kept) {
  return {kept.frames_written, kept.words.size(), [kept, at = std::size_t{0}](std::span<double> piece) mutable {
            for (double& word : piece) word = kept.words.at(at++);
          }};
}

}  // namespace tumble
