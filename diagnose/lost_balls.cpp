#include "diagnose/lost_balls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tumble::diagnose {
namespace {

constexpr double kAway = 0.06;     // [s]
constexpr std::size_t kSteps = 3;  // frames from which a path's velocity is taken

struct Track {
  std::vector<std::size_t> frames;
  std::vector<Sighting> balls;
};

struct End {  // of a track, first or last, and how it moves there
  std::size_t frame = 0;
  Sighting ball;
  double vx = 0, vy = 0;
};

class Mender {
 public:
  explicit Mender(std::vector<SeenFrame>& frames) : frames_(frames) {
    for (std::size_t f = 0; f < frames_.size(); ++f)
      for (const Sighting& s : frames_[f].balls) {
        Track& t = tracks_[s.ball];
        t.frames.push_back(f);
        t.balls.push_back(s);
      }
  }

  void mend() {
    for (const auto& [number, t] : tracks_)
      for (std::size_t k = 1; k < t.frames.size(); ++k) fill(t.frames[k - 1], t.balls[k - 1], t.frames[k], t.balls[k]);
    join();
    for (SeenFrame& f : frames_)
      std::sort(f.balls.begin(), f.balls.end(), [](const Sighting& a, const Sighting& b) { return a.ball < b.ball; });
  }

 private:
  double time(std::size_t frame) const { return frames_[frame].time; }

  void fill(std::size_t from, const Sighting& a, std::size_t to, const Sighting& b) {
    if (to - from < 2 || time(to) - time(from) > kAway) return;
    for (std::size_t f = from + 1; f < to; ++f) {
      const double share = (time(f) - time(from)) / (time(to) - time(from));
      Sighting s = a;
      s.x += share * (b.x - a.x);
      s.y += share * (b.y - a.y);
      s.spin += share * (b.spin - a.spin);
      s.guessed = true;
      frames_[f].balls.push_back(s);
    }
  }

  End end_of(const Track& t, bool last) const {
    const std::size_t here = last ? t.frames.size() - 1 : 0, steps = std::min(kSteps, t.frames.size() - 1),
                      there = last ? here - steps : here + steps;
    End e{t.frames[here], t.balls[here], 0, 0};
    if (steps == 0) return e;
    const double seconds = time(t.frames[here]) - time(t.frames[there]);
    e.vx = (t.balls[here].x - t.balls[there].x) / seconds;
    e.vy = (t.balls[here].y - t.balls[there].y) / seconds;
    return e;
  }

  // Each that begins, in order of time, with the end that it fits best.
  void join() {
    std::vector<End> ends, begins;
    for (const auto& [number, t] : tracks_) {
      if (t.frames.back() + 1 < frames_.size()) ends.push_back(end_of(t, true));
      if (t.frames.front() > 0) begins.push_back(end_of(t, false));
    }
    const auto earlier = [](const End& a, const End& b) { return a.frame < b.frame; };
    std::sort(ends.begin(), ends.end(), earlier);
    std::sort(begins.begin(), begins.end(), earlier);
    std::vector<char> taken(ends.size(), 0);
    std::size_t first = 0;  // that is not too long ago
    for (const End& b : begins) {
      while (first < ends.size() && time(b.frame) - time(ends[first].frame) > kAway) ++first;
      std::size_t best = ends.size();
      double least = b.ball.radius;
      for (std::size_t i = first; i < ends.size() && ends[i].frame < b.frame; ++i) {
        const End& a = ends[i];
        const double away = time(b.frame) - time(a.frame);
        if (taken[i]) continue;
        const double apart =
            std::hypot(b.ball.x - a.ball.x - (a.vx + b.vx) * away / 2, b.ball.y - a.ball.y - (a.vy + b.vy) * away / 2);
        if (apart < least) best = i, least = apart;
      }
      if (best == ends.size()) continue;
      taken[best] = 1;
      fill(ends[best].frame, ends[best].ball, b.frame, b.ball);
    }
  }

  std::vector<SeenFrame>& frames_;
  std::map<int, Track> tracks_;
};

}  // namespace

std::vector<SeenFrame> with_lost_balls(std::vector<SeenFrame> frames) {
  Mender(frames).mend();
  return frames;
}

}  // namespace tumble::diagnose
