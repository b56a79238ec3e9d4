#include "analysis/tracking.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/assignment.h"
#include "core/config.h"

namespace tumble::analysis {
namespace {

using Frames = std::vector<std::vector<Sighting>>;

constexpr int kGrid = 24;        // cells of the guess field across the drum
constexpr double kAlone = 40.0;  // cost of a path without a ball: more than any pairing within its gate

// What balls did at a place: mean displacement per frame and its spread.
struct FlowGuess {
  struct Cell {
    double n = 0, vx = 0, vy = 0, squares = 0;
  };
  double half = 1;
  std::vector<Cell> cells = std::vector<Cell>(static_cast<std::size_t>(kGrid) * kGrid);

  std::size_t index(double x, double y) const {
    const auto at = [&](double z) {
      return std::clamp(static_cast<int>((z + half) / (2 * half) * kGrid), 0, kGrid - 1);
    };
    return static_cast<std::size_t>(at(y)) * kGrid + static_cast<std::size_t>(at(x));
  }
  void add(double x, double y, double vx, double vy) {
    Cell& c = cells[index(x, y)];
    c.n += 1;
    c.vx += vx;
    c.vy += vy;
    c.squares += vx * vx + vy * vy;
  }
};

struct Path {
  int id = 0;
  int size_class = 0;
  double radius = 0;
  double x = 0, y = 0, vx = 0, vy = 0;    // last place, velocity
  int age = 0;                            // sightings
  int unseen = 0;                         // frames since the last one
  std::vector<std::pair<int, int>> seen;  // frame, index in it
};

struct Guess {
  double x, y, sigma;
};

class Linker {
 public:
  Linker(Frames& frames, const MotionModel& model) : frames_(frames), model_(model) {
    for (const auto& f : frames_)
      for (const Sighting& s : f) {
        field_.half = std::max(field_.half, std::hypot(s.x, s.y) + s.radius);
        mean_radius_ += s.radius;
        count_ += 1;
      }
    if (count_ > 0) mean_radius_ /= count_;
  }

  std::vector<Path> run(const FlowGuess* flow) {
    std::vector<Path> done, live;
    int next_id = 0;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      auto& found = frames_[f];
      std::vector<int> path_of(found.size(), -1);
      // Tight first, where each path expects its ball; then what is left over, within what a ball can do in a frame.
      for (int stage = 0; stage < 3; ++stage) {
        std::vector<Pairing> pairings;
        for (std::size_t p = 0; p < live.size(); ++p) {
          if (live[p].unseen == 0) continue;  // has its ball in this frame
          const std::vector<Guess> expected = guesses(live[p], flow, stage);
          for (std::size_t k = 0; k < found.size(); ++k) {
            if (path_of[k] >= 0 || found[k].size_class != live[p].size_class) continue;
            double least = kAlone;
            for (const Guess& g : expected) {  // the best of a path's guesses counts
              const double dx = found[k].x - g.x, dy = found[k].y - g.y, d2 = dx * dx + dy * dy;
              if (d2 > 9.0 * g.sigma * g.sigma) continue;
              least = std::min(least, d2 / (g.sigma * g.sigma) + 2.0 * std::log(g.sigma / mean_radius_) + 20.0);
            }
            if (least < kAlone) pairings.push_back({static_cast<int>(p), static_cast<int>(k), least});
          }
        }
        for (const auto& [p, k] : assign(pairings, kAlone)) {
          path_of[static_cast<std::size_t>(k)] = p;
          take(live[static_cast<std::size_t>(p)], f, static_cast<std::size_t>(k));
        }
      }
      for (std::size_t k = 0; k < found.size(); ++k) {
        if (path_of[k] >= 0 || found[k].score < model_.birth_score) continue;
        Path path;
        path.id = next_id++;
        path.size_class = found[k].size_class;
        path.radius = found[k].radius;
        take(path, f, k);
        live.push_back(path);
      }
      std::vector<Path> still_live;
      for (Path& path : live) {
        if (path.unseen > model_.patience) {
          done.push_back(std::move(path));
        } else {
          ++path.unseen;  // until the next frame shows it
          still_live.push_back(std::move(path));
        }
      }
      live = std::move(still_live);
    }
    done.insert(done.end(), std::make_move_iterator(live.begin()), std::make_move_iterator(live.end()));
    std::sort(done.begin(), done.end(), [](const Path& a, const Path& b) { return a.id < b.id; });
    return done;
  }

  FlowGuess flow_of(const std::vector<Path>& paths) const {
    FlowGuess flow = field_;
    for (const Path& path : paths) {
      if (path.seen.size() < 4) continue;
      for (std::size_t i = 1; i < path.seen.size(); ++i) {
        const Sighting& a = at(path.seen[i - 1]);
        const Sighting& b = at(path.seen[i]);
        const double gap = path.seen[i].first - path.seen[i - 1].first;
        flow.add(a.x, a.y, (b.x - a.x) / gap, (b.y - a.y) / gap);
      }
    }
    return flow;
  }

 private:
  const Sighting& at(const std::pair<int, int>& where) const {
    return frames_[static_cast<std::size_t>(where.first)][static_cast<std::size_t>(where.second)];
  }

  void take(Path& path, std::size_t f, std::size_t k) {
    const Sighting& s = frames_[f][k];
    if (path.age > 0) {
      const double gap = static_cast<double>(f) - path.seen.back().first;
      // The newest displacement, with gravity's half step put back to the present.
      path.vx = (s.x - path.x) / gap;
      path.vy = (s.y - path.y) / gap;
    }
    path.x = s.x;
    path.y = s.y;
    path.unseen = 0;
    ++path.age;
    path.seen.emplace_back(static_cast<int>(f), static_cast<int>(k));
  }

  std::vector<Guess> guesses(const Path& path, const FlowGuess* flow, int stage) const {
    const double r = path.radius, n = path.unseen;
    const double c = std::cos(model_.turn * n), s = std::sin(model_.turn * n);
    const Guess carried{c * path.x - s * path.y, s * path.x + c * path.y, 0};
    std::vector<Guess> list;
    const auto add = [&](double x, double y, double sigma) { list.push_back({x, y, sigma}); };
    if (path.age >= 2) {
      const double speed = std::hypot(path.vx, path.vy);
      const double free_y = path.y + path.vy * n - 0.5 * model_.gravity * n * (n + 1);
      const double open = stage == 0   ? 0.10 * r + 0.06 * speed
                          : stage == 1 ? 0.3 * r + 0.2 * speed
                                       : 0.4 * r + 0.5 * speed;
      const double sigma = open * std::sqrt(n);
      add(path.x + path.vx * n, path.y + path.vy * n, sigma);
      add(path.x + path.vx * n, free_y, sigma);
      if (stage > 0) add(carried.x, carried.y, sigma);
      // Bodily turn with the drum bends the path of a carried ball.
      add(path.x + c * path.vx * n - s * path.vy * n, path.y + s * path.vx * n + c * path.vy * n, sigma);
    } else {
      add(carried.x, carried.y, (stage == 0 ? 0.12 : stage == 1 ? 0.3 : 0.6) * r * std::sqrt(n));
      if (flow != nullptr) {
        const FlowGuess::Cell& cell = flow->cells[flow->index(path.x, path.y)];
        if (cell.n >= 3) {
          const double vx = cell.vx / cell.n, vy = cell.vy / cell.n;
          const double spread = std::sqrt(std::max(0.0, 0.5 * (cell.squares / cell.n - vx * vx - vy * vy)));
          add(path.x + vx * n, path.y + vy * n, (stage + 1) * (0.1 * r + 0.5 * spread) * std::sqrt(n));
        }
      } else if (stage == 2) {
        add(path.x, path.y - 0.5 * r, 1.0 * r * n);
      }
    }
    if (stage == 2 && flow != nullptr) {
      const FlowGuess::Cell& cell = flow->cells[flow->index(path.x, path.y)];
      if (cell.n >= 3) {
        const double vx = cell.vx / cell.n, vy = cell.vy / cell.n;
        const double spread = std::sqrt(std::max(0.0, 0.5 * (cell.squares / cell.n - vx * vx - vy * vy)));
        add(path.x + vx * n, path.y + vy * n, (0.2 * r + spread) * std::sqrt(n));
      }
    }
    return list;
  }

  Frames& frames_;
  const MotionModel& model_;
  FlowGuess field_;
  double mean_radius_ = 0, count_ = 0;
};

// A thing that stays in its place while the drum carries balls by several radii is part of the picture.
bool stands_still(const Path& path, const Frames& frames, const MotionModel& model) {
  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
  for (const auto& [f, k] : path.seen) {
    const Sighting& s = frames[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)];
    x0 = std::min(x0, s.x);
    x1 = std::max(x1, s.x);
    y0 = std::min(y0, s.y);
    y1 = std::max(y1, s.y);
  }
  const double frames_seen = path.seen.back().first - path.seen.front().first;
  const double carried = std::abs(model.turn) * frames_seen * 0.5 * model.tip_radius;
  return carried > 4 * path.radius && std::hypot(x1 - x0, y1 - y0) < 0.3 * path.radius;
}

}  // namespace

int link_sightings(Frames& frames, const MotionModel& model) {
  Linker linker(frames, model);
  const FlowGuess flow = linker.flow_of(linker.run(nullptr));
  const std::vector<Path> paths = linker.run(&flow);
  for (auto& f : frames)
    for (Sighting& s : f) s.track = -1;
  int id = 0;
  for (const Path& path : paths) {
    if (path.seen.size() < 2 && frames.size() > 2) continue;  // seen once: as likely a trick of the light
    if (stands_still(path, frames, model)) continue;
    for (const auto& [f, k] : path.seen) frames[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)].track = id;
    ++id;
  }
  return id;
}

void smooth_velocities(Frames& frames, int window) {
  std::map<int, std::vector<std::pair<int, Sighting*>>> paths;
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (Sighting& s : frames[f]) {
      s.vx = s.vy = kNotGiven;
      if (s.track >= 0) paths[s.track].emplace_back(static_cast<int>(f), &s);
    }
  const int half = window / 2;
  for (auto& [id, seen] : paths) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
      std::size_t a = i, b = i;
      while (a > 0 && seen[i].first - seen[a - 1].first <= half) --a;
      while (b + 1 < seen.size() && seen[b + 1].first - seen[i].first <= half) ++b;
      double s0 = 0, s1 = 0, s2 = 0, s3 = 0, s4 = 0, x0 = 0, x1 = 0, x2 = 0, y0 = 0, y1 = 0, y2 = 0;
      for (std::size_t k = a; k <= b; ++k) {
        const double t = seen[k].first - seen[i].first, x = seen[k].second->x, y = seen[k].second->y;
        s0 += 1;
        s1 += t;
        s2 += t * t;
        s3 += t * t * t;
        s4 += t * t * t * t;
        x0 += x;
        x1 += x * t;
        x2 += x * t * t;
        y0 += y;
        y1 += y * t;
        y2 += y * t * t;
      }
      const double det = s0 * (s2 * s4 - s3 * s3) - s1 * (s1 * s4 - s2 * s3) + s2 * (s1 * s3 - s2 * s2);
      if (b - a >= 2 && det > 1e-9) {  // slope of the parabola at the frame itself
        const auto slope = [&](double m0, double m1, double m2) {
          return (s0 * (m1 * s4 - m2 * s3) - m0 * (s1 * s4 - s2 * s3) + s2 * (s1 * m2 - s2 * m1)) / det;
        };
        seen[i].second->vx = slope(x0, x1, x2);
        seen[i].second->vy = slope(y0, y1, y2);
      } else if (b > a) {
        const double d = s0 * s2 - s1 * s1;
        seen[i].second->vx = (s0 * x1 - s1 * x0) / d;
        seen[i].second->vy = (s0 * y1 - s1 * y0) / d;
      }
    }
  }
}

}  // namespace tumble::analysis
