#include "analysis/path_linker.h"

#include <algorithm>
#include <cmath>

#include "analysis/assignment.h"
#include "core/quantile.h"

namespace tumble::analysis {
namespace {

constexpr int kGrid = 24;            // cells of the guess field across the drum
constexpr double kAlone = 40.0;      // cost of a path without a ball: more than any pairing within its gate
constexpr double kBirthScore = 0.3;  // of a ball with which a path may begin

struct Guess {
  double x, y, sigma;
};

struct LivePath {
  Path path;
  double x = 0, y = 0, vx = 0, vy = 0, time = 0;  // last place, velocity
  bool taken = false;                             // has its ball in this frame
  const Sighting* last = nullptr;
};

class Linker {
 public:
  Linker(std::vector<SeenFrame>& frames, const MotionModel& model, const FlowGuess* flow, double noise)
      : frames_(frames), model_(model), flow_(flow), colour_noise_(noise) {
    double count = 0;
    for (const SeenFrame& f : frames_)
      for (const Sighting& s : f.balls) {
        mean_radius_ += s.radius;
        count += 1;
      }
    if (count > 0) mean_radius_ /= count;
  }

  std::vector<Path> run() {
    std::vector<Path> done;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      SeenFrame& frame = frames_[f];
      std::vector<char> used(frame.balls.size(), 0);
      for (LivePath& p : live_) p.taken = false;
      // Tight first, where each path expects its ball; then what is left over, within what a ball can do in a frame.
      for (int stage = 0; stage < 3; ++stage) link(f, stage, used);
      for (std::size_t k = 0; k < used.size(); ++k) {
        if (used[k] || frame.balls[k].score < kBirthScore) continue;
        LivePath p;
        p.path.size_class = frame.balls[k].size_class;
        p.path.radius = frame.balls[k].radius;
        take(p, f, k, kNotGiven);
        live_.push_back(std::move(p));
      }
      std::vector<LivePath> still;
      for (LivePath& p : live_) {
        if (frame.time - p.time > model_.patience)
          done.push_back(std::move(p.path));
        else
          still.push_back(std::move(p));
      }
      live_ = std::move(still);
    }
    for (LivePath& p : live_) done.push_back(std::move(p.path));
    std::sort(done.begin(), done.end(), [](const Path& a, const Path& b) { return a.seen.front() < b.seen.front(); });
    return done;
  }

 private:
  void link(std::size_t f, int stage, std::vector<char>& used) {
    std::vector<Sighting>& found = frames_[f].balls;
    std::vector<Pairing> pairings;
    std::vector<double> by_row(live_.size(), std::exp(-0.5 * kAlone)), by_column(found.size(), std::exp(-0.5 * kAlone));
    for (std::size_t p = 0; p < live_.size(); ++p) {
      if (live_[p].taken) continue;
      const std::vector<Guess> expected = guesses(live_[p], frames_[f].time, stage);
      for (std::size_t k = 0; k < found.size(); ++k) {
        if (used[k] || found[k].size_class != live_[p].path.size_class) continue;
        double least = kAlone;
        for (const Guess& g : expected) {  // the best of a path's guesses counts
          const double dx = found[k].x - g.x, dy = found[k].y - g.y, d2 = dx * dx + dy * dy;
          if (d2 > 9.0 * g.sigma * g.sigma) continue;
          least = std::min(least, d2 / (g.sigma * g.sigma) + 2.0 * std::log(g.sigma / mean_radius_) + 18.0);
        }
        if (least >= kAlone) continue;
        least += colour_cost(*live_[p].last, found[k], colour_noise_);
        pairings.push_back({static_cast<int>(p), static_cast<int>(k), least});
        by_row[p] += std::exp(-0.5 * least);
        by_column[k] += std::exp(-0.5 * least);
      }
    }
    std::vector<std::vector<std::pair<int, double>>> cost_of(live_.size());
    for (const Pairing& p : pairings) cost_of[static_cast<std::size_t>(p.row)].emplace_back(p.column, p.cost);
    for (const auto& [row, column] : assign(pairings, kAlone)) {
      const auto p = static_cast<std::size_t>(row), k = static_cast<std::size_t>(column);
      const auto it =
          std::find_if(cost_of[p].begin(), cost_of[p].end(), [&](const auto& c) { return c.first == column; });
      const double weight = std::exp(-0.5 * it->second);
      used[k] = 1;
      take(live_[p], f, k, std::min(weight / by_row[p], weight / by_column[k]));
    }
  }

  void take(LivePath& p, std::size_t f, std::size_t k, double confidence) {
    Sighting& s = frames_[f].balls[k];
    s.confidence = confidence;
    if (!p.path.seen.empty()) {
      const double gap = frames_[f].time - p.time;
      p.vx = (s.x - p.x) / gap;
      p.vy = (s.y - p.y) / gap;
    }
    p.x = s.x;
    p.y = s.y;
    p.time = frames_[f].time;
    p.taken = true;
    p.last = &s;
    p.path.seen.emplace_back(static_cast<int>(f), static_cast<int>(k));
  }

  std::vector<Guess> guesses(const LivePath& p, double time, int stage) const {
    const double r = p.path.radius, n = time - p.time;
    const double c = std::cos(model_.turn * n), s = std::sin(model_.turn * n);
    const double cx = c * p.x - s * p.y, cy = s * p.x + c * p.y;  // carried with the drum
    const double noise = 2 * p.last->deviation;
    std::vector<Guess> list;
    const auto add = [&](double x, double y, double sigma) { list.push_back({x, y, std::hypot(sigma, noise)}); };
    if (p.path.seen.size() >= 2) {
      const double speed = std::hypot(p.vx, p.vy);
      const double open = stage == 0   ? 0.10 * r + 0.06 * speed
                          : stage == 1 ? 0.3 * r + 0.2 * speed
                                       : 0.4 * r + 0.5 * speed;
      const double sigma = open * std::sqrt(n), fall = 0.5 * n * (n + 1);  // the velocity is half a step old
      add(p.x + p.vx * n, p.y + p.vy * n, sigma);
      add(p.x + p.vx * n + model_.gravity_x * fall, p.y + p.vy * n + model_.gravity_y * fall, sigma);
      if (stage > 0) add(cx, cy, sigma);
      // Bodily turn with the drum bends the path of a carried ball.
      add(p.x + c * p.vx * n - s * p.vy * n, p.y + s * p.vx * n + c * p.vy * n, sigma);
    } else {
      add(cx, cy, (stage == 0 ? 0.12 : stage == 1 ? 0.3 : 0.6) * r * std::sqrt(n));
      if (flow_ == nullptr && stage == 2) add(p.x, p.y - 0.5 * r, 1.0 * r * n);
    }
    if (flow_ != nullptr && (stage == 2 || p.path.seen.size() < 2)) {
      const FlowGuess::Motion m = flow_->at(p.x, p.y);
      if (m.known) {
        const double open = stage == 2 ? 0.2 * r + m.spread : (stage + 1) * (0.1 * r + 0.5 * m.spread);
        add(p.x + m.vx * n, p.y + m.vy * n, open * std::sqrt(n));
      }
    }
    return list;
  }

  std::vector<SeenFrame>& frames_;
  const MotionModel& model_;
  const FlowGuess* flow_;
  double colour_noise_;
  double mean_radius_ = 0;
  std::vector<LivePath> live_;
};

const Sighting& at(const std::vector<SeenFrame>& frames, const std::pair<int, int>& where) {
  return frames[static_cast<std::size_t>(where.first)].balls[static_cast<std::size_t>(where.second)];
}

double time_of(const std::vector<SeenFrame>& frames, const std::pair<int, int>& where) {
  return frames[static_cast<std::size_t>(where.first)].time;
}

// Where a path begins or ends, and how fast.
struct End {
  double x = 0, y = 0, vx = 0, vy = 0, time = 0;
  bool moving = false;  // its velocity is known
};

End end_of(const Path& path, const std::vector<SeenFrame>& frames, bool last, const FlowGuess& flow) {
  const std::size_t n = path.seen.size(), here = last ? n - 1 : 0;
  const Sighting& s = at(frames, path.seen[here]);
  End e{s.x, s.y, 0, 0, time_of(frames, path.seen[here]), false};
  if (n >= 2) {
    const std::size_t reach = std::min<std::size_t>(n - 1, 2), there = last ? here - reach : reach;
    const Sighting& o = at(frames, path.seen[there]);
    const double gap = e.time - time_of(frames, path.seen[there]);
    e.vx = (s.x - o.x) / gap;
    e.vy = (s.y - o.y) / gap;
    e.moving = true;
  } else if (const FlowGuess::Motion m = flow.at(s.x, s.y); m.known) {
    e.vx = m.vx;
    e.vy = m.vy;
  }
  return e;
}

// How badly two ends fit over their gap, in squared spreads: as a straight line, a fall, or carried by the drum,
// looked at from both sides.
double gap_cost(const End& a, const End& b, double radius, const MotionModel& model) {
  const double n = b.time - a.time, c = std::cos(model.turn * n), s = std::sin(model.turn * n);
  const double fall = 0.5 * n * (n + 1);
  const double spread = std::hypot(0.25 * radius, 0.10 * radius * n + 0.1 * std::hypot(b.vx - a.vx, b.vy - a.vy) * n);
  const auto miss = [&](double x, double y, const End& e) {
    return ((x - e.x) * (x - e.x) + (y - e.y) * (y - e.y)) / (spread * spread);
  };
  double best = 1e9;
  for (const double g : {0.0, 1.0}) {
    const double fx = g * model.gravity_x * fall, fy = g * model.gravity_y * fall;
    best = std::min(best, 0.5 * (miss(a.x + a.vx * n + fx, a.y + a.vy * n + fy, b) +
                                 miss(b.x - b.vx * n + fx, b.y - b.vy * n + fy, a)));
  }
  return std::min(best, miss(c * a.x - s * a.y, s * a.x + c * a.y, b) + (a.moving && b.moving ? 1.0 : 0.0)) +
         2 * std::log(spread / (0.25 * radius));
}

}  // namespace

FlowGuess::FlowGuess(const std::vector<SeenFrame>& frames) : cells_(static_cast<std::size_t>(kGrid) * kGrid) {
  half_ = 0;
  for (const SeenFrame& f : frames)
    for (const Sighting& s : f.balls) half_ = std::max(half_, std::hypot(s.x, s.y) + s.radius);
  if (half_ == 0) half_ = 1;
}

std::size_t FlowGuess::index(double x, double y) const {
  const auto cell = [&](double z) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>((z + half_) / (2 * half_) * kGrid), 0, kGrid - 1));
  };
  return cell(y) * kGrid + cell(x);
}

void FlowGuess::add(double x, double y, double vx, double vy) {
  Cell& c = cells_[index(x, y)];
  c.n += 1;
  c.vx += vx;
  c.vy += vy;
  c.squares += vx * vx + vy * vy;
}

FlowGuess::Motion FlowGuess::at(double x, double y) const {
  const Cell& c = cells_[index(x, y)];
  if (c.n < 3) return {};
  const double vx = c.vx / c.n, vy = c.vy / c.n;
  return {true, vx, vy, std::sqrt(std::max(0.0, 0.5 * (c.squares / c.n - vx * vx - vy * vy)))};
}

FlowGuess flow_of(const std::vector<SeenFrame>& frames, const std::vector<Path>& paths) {
  FlowGuess flow(frames);
  for (const Path& path : paths) {
    if (path.seen.size() < 4) continue;
    for (std::size_t i = 1; i < path.seen.size(); ++i) {
      const Sighting& a = at(frames, path.seen[i - 1]);
      const Sighting& b = at(frames, path.seen[i]);
      const double gap = time_of(frames, path.seen[i]) - time_of(frames, path.seen[i - 1]);
      flow.add(a.x, a.y, (b.x - a.x) / gap, (b.y - a.y) / gap);
    }
  }
  return flow;
}

double colour_noise(const std::vector<SeenFrame>& frames, const std::vector<Path>& paths) {
  std::vector<double> changes;
  for (const Path& path : paths)
    for (std::size_t i = 1; path.seen.size() >= 4 && i < path.seen.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        changes.push_back(std::abs(at(frames, path.seen[i]).colour[c] - at(frames, path.seen[i - 1]).colour[c]));
  if (changes.size() < 100) return kNotGiven;
  return 2.0 + 2 * 1.48 * median_of(std::move(changes));  // tails are long: marks turn, lights pass
}

double colour_cost(const Sighting& a, const Sighting& b, double noise) {
  if (std::isnan(noise)) return 0;
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += std::pow((a.colour[c] - b.colour[c]) / noise, 2);
  return std::min(9.0, sum / 3);
}

std::vector<Path> link_frames(std::vector<SeenFrame>& frames, const MotionModel& model, const FlowGuess* flow,
                              double noise) {
  return Linker(frames, model, flow, noise).run();
}

std::vector<Path> join_paths(std::vector<Path> paths, std::vector<SeenFrame>& frames, const MotionModel& model,
                             const FlowGuess& flow, double noise) {
  constexpr double kMost = 12.0;  // cost beyond which ends are left loose
  std::vector<End> ends, starts;
  for (const Path& p : paths) {
    ends.push_back(end_of(p, frames, true, flow));
    starts.push_back(end_of(p, frames, false, flow));
  }
  std::vector<std::size_t> by_start(paths.size());
  for (std::size_t i = 0; i < by_start.size(); ++i) by_start[i] = i;
  std::sort(by_start.begin(), by_start.end(),
            [&](std::size_t a, std::size_t b) { return starts[a].time < starts[b].time; });
  std::vector<Pairing> pairings;
  for (std::size_t a = 0; a < paths.size(); ++a) {
    auto b = std::upper_bound(by_start.begin(), by_start.end(), ends[a].time,
                              [&](double t, std::size_t i) { return t < starts[i].time; });
    for (; b != by_start.end() && starts[*b].time - ends[a].time <= model.longest_gap; ++b) {
      if (paths[*b].size_class != paths[a].size_class) continue;
      const double cost = gap_cost(ends[a], starts[*b], paths[a].radius, model) +
                          colour_cost(at(frames, paths[a].seen.back()), at(frames, paths[*b].seen.front()), noise);
      if (cost < kMost) pairings.push_back({static_cast<int>(a), static_cast<int>(*b), cost});
    }
  }
  std::vector<int> next(paths.size(), -1);
  std::vector<char> follows(paths.size(), 0);
  for (const auto& [a, b] : assign(pairings, kMost)) {
    next[static_cast<std::size_t>(a)] = b;
    follows[static_cast<std::size_t>(b)] = 1;
    double others = std::exp(-0.5 * kMost), own = 0;
    for (const Pairing& p : pairings) {
      if (p.row != a && p.column != b) continue;
      others += std::exp(-0.5 * p.cost);
      if (p.row == a && p.column == b) own = std::exp(-0.5 * p.cost);
    }
    const auto [f, k] = paths[static_cast<std::size_t>(b)].seen.front();
    frames[static_cast<std::size_t>(f)].balls[static_cast<std::size_t>(k)].confidence = own / others;
  }
  std::vector<Path> joined;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (follows[i]) continue;
    Path whole = std::move(paths[i]);
    for (int j = next[i]; j >= 0; j = next[static_cast<std::size_t>(j)]) {
      const Path& more = paths[static_cast<std::size_t>(j)];
      whole.seen.insert(whole.seen.end(), more.seen.begin(), more.seen.end());
    }
    joined.push_back(std::move(whole));
  }
  return joined;
}

}  // namespace tumble::analysis
