#include "analysis/film_paths.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/angle.h"

namespace tumble::analysis {
namespace {

using TrackIds = std::vector<std::vector<int>>;  // by frame, by ball

// Numbers for a chapter's own tracks: of two that share sightings with the chapter before, that with which they share
// most; else a new one.
std::vector<int> numbers_of(const std::vector<SeenFrame>& chapter, int tracks, const TrackIds& before, int& next) {
  std::map<std::pair<int, int>, int> shared;  // (track before, track now) -> sightings
  for (std::size_t f = 0; f < before.size(); ++f)
    for (std::size_t k = 0; k < before[f].size(); ++k) {
      const int then = before[f][k], now = chapter[f].balls[k].track;
      if (then >= 0 && now >= 0) ++shared[{then, now}];
    }
  std::vector<std::pair<int, std::pair<int, int>>> by_count;
  for (const auto& [pair, count] : shared) by_count.push_back({-count, pair});
  std::sort(by_count.begin(), by_count.end());
  std::vector<int> number(static_cast<std::size_t>(tracks), -1);
  std::map<int, bool> taken;
  for (const auto& [count, pair] : by_count) {
    int& mine = number[static_cast<std::size_t>(pair.second)];
    if (mine >= 0 || taken[pair.first]) continue;
    mine = pair.first;
    taken[pair.first] = true;
  }
  for (int& n : number)
    if (n < 0) n = next++;
  return number;
}

}  // namespace

Chapters chapters_of(double turn) {
  constexpr double kLeast = 800, kMost = 4000;
  const double revolution = turn != 0 ? 2 * kPi / std::abs(turn) : kMost;
  return {static_cast<std::size_t>(std::clamp(1.2 * revolution, kLeast, kMost)), 160};
}

void link_in_chapters(std::size_t frames, const PlacesOf& places, const Chapters& chapters, const MotionModel& model,
                      const std::function<void(std::vector<SeenFrame>&)>& finish, const UseFrame& use) {
  TrackIds shared;  // of the frames that this chapter shares with the one before
  int next_number = 0;
  std::size_t used = 0;
  for (std::size_t start = 0; used < frames;) {
    // A rest that is hardly longer than the overlap belongs to this chapter.
    const bool last = start + chapters.length + chapters.overlap >= frames;
    const std::size_t end = last ? frames : start + chapters.length;
    std::vector<SeenFrame> chapter;
    for (std::size_t f = start; f < end; ++f) chapter.push_back(places(f));
    const int tracks = link_sightings(chapter, model);
    const std::vector<int> number = numbers_of(chapter, tracks, shared, next_number);
    for (SeenFrame& frame : chapter)
      for (Sighting& s : frame.balls)
        if (s.track >= 0) s.track = number[static_cast<std::size_t>(s.track)];
    const std::size_t again = last ? frames : end - chapters.overlap;  // where the next one begins
    shared.clear();
    for (std::size_t f = again; f < end; ++f) {
      shared.emplace_back();
      for (const Sighting& s : chapter[f - start].balls) shared.back().push_back(s.track);
    }
    finish(chapter);
    const std::vector<SeenFrame> bridged = bridged_sightings(chapter);
    // In the middle of the overlap both chapters know enough of what comes and went.
    for (const std::size_t to = last ? frames : again + chapters.overlap / 2; used < to; ++used)
      use(used, chapter[used - start], bridged[used - start]);
    start = again;
  }
}

}  // namespace tumble::analysis
