#include "diagnose/observation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/experiments.h"
#include "core/units.h"
#include "diagnose/contact_laws.h"

namespace tumble::diagnose {
namespace {

constexpr int kUsualPockets = 18;
constexpr std::size_t kAngleCount = 6, kFlightCount = 4;
constexpr double kReach = 1.04;  // [R]: cells up to here may hold a ball's share

// Balls rest on the lifters' tips, just where pockets end: within so many radii a ball counts in part, so that no noise
// of its place makes it count or not.
constexpr double kRamp = 1.5;
constexpr double kOnFrame = 1e-6;  // [frames]: nearer than that, a moment is the frame's own

// Finds balls by number in a list that is sorted by it, asked for in that order.
template <class Place>
class Follower {
 public:
  explicit Follower(const std::vector<Place>& places) : at_(places.begin()), end_(places.end()) {}
  const Place* find(int ball) {
    while (at_ != end_ && at_->ball < ball) ++at_;
    return at_ != end_ && at_->ball == ball ? &*at_ : nullptr;
  }

 private:
  typename std::vector<Place>::const_iterator at_, end_;
};

}  // namespace

const char* name_of(Observable observable) {
  switch (observable) {
    case Observable::kTorque:
      return "torque";
    case Observable::kClosure:
      return "torque_closure";
    case Observable::kAngles:
      return "toe_and_shoulder";
    case Observable::kOccupancy:
      return "occupancy";
    case Observable::kMomentum:
      return "velocity";
    case Observable::kAgitation:
      return "agitation";
    case Observable::kSpin:
      return "spin";
    case Observable::kPockets:
      return "pockets";
    case Observable::kFlight:
      return "flight";
    case Observable::kLaws:
      break;
  }
  return "laws";
}

ObservationLayout::ObservationLayout(int lifter_count) : pockets(lifter_count > 0 ? lifter_count : kUsualPockets) {
  cell_at.assign(kCells * kCells, -1);
  for (int v = 0; v < kCells; ++v)
    for (int u = 0; u < kCells; ++u) {
      const Cell cell{(u + 0.5) * 2 / kCells - 1, (v + 0.5) * 2 / kCells - 1};
      if (std::hypot(cell.x, cell.y) > kReach) continue;
      cell_at[static_cast<std::size_t>(v * kCells + u)] = static_cast<int>(cells.size());
      cells.push_back(cell);
    }
}

std::size_t ObservationLayout::count(Observable observable) const {
  switch (observable) {
    case Observable::kTorque:
    case Observable::kClosure:
      return 1;
    case Observable::kAngles:
      return kAngleCount;
    case Observable::kOccupancy:
    case Observable::kAgitation:
    case Observable::kSpin:
      return cells.size();
    case Observable::kMomentum:
      return 2 * cells.size();
    case Observable::kPockets:
      return 2 * static_cast<std::size_t>(pockets);
    case Observable::kFlight:
      return kFlightCount;
    case Observable::kLaws:
      break;
  }
  return kLawNumbers;
}

std::size_t ObservationLayout::first(Observable observable) const {
  std::size_t at = 0;
  for (const Observable o : kObservables) {
    if (o == observable) break;
    at += count(o);
  }
  return at;
}

std::size_t ObservationLayout::size() const { return first(kObservables.back()) + count(kObservables.back()); }

Observable ObservationLayout::observable_of(std::size_t i) const {
  Observable found = kObservables.front();
  for (const Observable o : kObservables)
    if (i >= first(o)) found = o;
  return found;
}

std::string ObservationLayout::region(std::size_t i) const {
  const Observable o = observable_of(i);
  const std::size_t k = i - first(o);
  switch (o) {
    case Observable::kAngles:
      return kScalarData[2 + k].name;
    case Observable::kOccupancy:
    case Observable::kMomentum:
    case Observable::kAgitation:
    case Observable::kSpin: {
      const Cell& c = cells[k % cells.size()];
      const double deg = std::atan2(c.y, c.x) * 180 / kPi;
      const std::string place = fmt::format("at {:.0f} deg, {:.2f} R", deg < 0 ? deg + 360 : deg, std::hypot(c.x, c.y));
      return o == Observable::kMomentum ? (k < cells.size() ? "x " : "y ") + place : place;
    }
    case Observable::kPockets:
      return fmt::format("{} lifter {}", k < count(o) / 2 ? "balls before" : "slip before", k % (count(o) / 2));
    case Observable::kFlight:
      return std::array{"x", "y", "x by velocity", "y by velocity"}[k];
    case Observable::kLaws:
      return name_of_law_number(k);
    default:
      return "mill";
  }
}

std::vector<double> turned_on(const ObservationLayout& layout, std::vector<double> numbers, int lifters) {
  const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(layout.first(Observable::kPockets));
  for (const int half : {0, 1})
    std::rotate(first + half * layout.pockets, first + half * layout.pockets + lifters,
                first + (half + 1) * layout.pockets);
  return numbers;
}

MapSums::MapSums(const ObservationLayout& layout, double mill_radius, double tip_radius, double mean_radius,
                 std::vector<View> views, std::size_t stride)
    : layout_(&layout),
      radius_(mill_radius),
      ring_(tip_radius - mean_radius),
      ramp_(kRamp * mean_radius),
      stride_(stride) {
  for (const View& v : views) {
    const double longer = 1 + v.observer.scale, reach = v.span / (1 + v.observer.clock);
    views_.push_back({v, std::cos(v.observer.rotation) * longer, std::sin(v.observer.rotation) * longer, reach,
                      std::vector<double>(layout.size(), 0.0)});
    longest_ = std::max(longest_, 2 * reach);
  }
}

void MapSums::add(double time, double mill_angle, std::vector<Sighting> balls) {
  window_.push_back({time, mill_angle, std::move(balls)});
  const double tiny = 1e-9 * std::max(1.0, time);
  while (window_.size() >= 3 && window_.back().time + tiny >= window_.front().time + 2 * longest_) {
    std::size_t middle = 1;
    while (window_[middle].time + tiny < window_.front().time + longest_) ++middle;
    if (window_[middle].time + longest_ > window_.back().time + tiny) break;
    if (frames_++ % stride_ == 0) {
      moments_.clear();
      for (Sums& sums : views_) deposit(sums, window_[middle]);
    }
    window_.pop_front();
  }
}

// Straight between two frames; only balls that both show. Views share the moments that they look at.
const MapSums::Moment& MapSums::moment_at(double time) {
  for (const Moment& m : moments_)
    if (std::abs(m.time - time) < 1e-9) return m;
  Moment moment{time, 0, {}};
  auto& places = moment.places;
  std::size_t next = 1;
  while (next + 1 < window_.size() && window_[next].time < time) ++next;
  const Seen &a = window_[next - 1], &b = window_[next];
  const double share = std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0);
  places.reserve(a.balls.size());
  if (share < kOnFrame || share > 1 - kOnFrame) {
    for (const Sighting& s : (share < 0.5 ? a : b).balls) places.push_back({s.ball, s.x, s.y});
  } else {
    for (std::size_t i = 0, j = 0; i < a.balls.size() && j < b.balls.size();) {
      const Sighting &p = a.balls[i], &q = b.balls[j];
      if (p.ball == q.ball) places.push_back({p.ball, p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)});
      i += p.ball <= q.ball;
      j += q.ball <= p.ball;
    }
  }
  moment.mill_angle = a.mill_angle + share * (b.mill_angle - a.mill_angle);
  return moments_.emplace_back(std::move(moment));
}

void MapSums::deposit(Sums& sums, const Seen& at) {
  const double twice = 2 * sums.view.span;
  const Moment &start = moment_at(at.time - sums.reach), &end = moment_at(at.time + sums.reach),
               &long_before = moment_at(at.time - 2 * sums.reach), &long_after = moment_at(at.time + 2 * sums.reach);
  const double mill_speed = (end.mill_angle - start.mill_angle) / twice;
  ++sums.frames;
  const std::size_t cells = layout_->cells.size(), pocket_count = static_cast<std::size_t>(layout_->pockets);
  double* const occupancy = sums.values.data() + layout_->first(Observable::kOccupancy);
  double* const momentum = sums.values.data() + layout_->first(Observable::kMomentum);
  double* const agitation = sums.values.data() + layout_->first(Observable::kAgitation);
  double* const spin = sums.values.data() + layout_->first(Observable::kSpin);
  double* const pockets = sums.values.data() + layout_->first(Observable::kPockets);
  const double cell = 2 * radius_ / kCells, per_cell = 1 / (cell * cell);
  const double c = sums.cosine, sn = sums.sine, stretch = (c * c + sn * sn) / (twice * twice);
  Follower before(start.places), after(end.places), farther_before(long_before.places),
      farther_after(long_after.places);
  for (const Sighting& s : at.balls) {
    const Place *from = before.find(s.ball), *to = after.find(s.ball);
    const Place *farther_from = farther_before.find(s.ball), *farther_to = farther_after.find(s.ball);
    if (from == nullptr || to == nullptr) continue;
    const double dx = (to->x - from->x) / twice, dy = (to->y - from->y) / twice;
    const double x = c * s.x - sn * s.y, y = sn * s.x + c * s.y, vx = c * dx - sn * dy, vy = sn * dx + c * dy;
    const double area = kPi * s.radius * s.radius * per_cell, turns = s.spin / (1 + sums.view.observer.clock);
    const bool is_told = !std::isnan(turns);
    ++sums.balls;
    sums.spins += is_told;
    const bool is_followed = farther_from != nullptr && farther_to != nullptr;
    sums.squares += is_followed;
    const double square = is_followed ? 4 * stretch *
                                            ((from->x - farther_from->x) * (farther_to->x - to->x) +
                                             (from->y - farther_from->y) * (farther_to->y - to->y))
                                      : 0;
    // To the four cells around, so that no number jumps when a ball crosses an edge.
    const double u = (x / radius_ + 1) * kCells / 2 - 0.5, v = (y / radius_ + 1) * kCells / 2 - 0.5;
    const int u0 = static_cast<int>(std::floor(u)), v0 = static_cast<int>(std::floor(v));
    std::array<std::size_t, 4> near{};
    std::array<double, 4> shares{};
    std::size_t known = 0;
    double sum = 0;
    for (int dv = 0; dv < 2; ++dv)
      for (int du = 0; du < 2; ++du) {
        const int cu = u0 + du, cv = v0 + dv;
        if (cu < 0 || cv < 0 || cu >= kCells || cv >= kCells) continue;
        const int index = layout_->cell_at[static_cast<std::size_t>(cv * kCells + cu)];
        if (index < 0) continue;
        near[known] = static_cast<std::size_t>(index);
        sum += shares[known++] = (du ? u - u0 : 1 - (u - u0)) * (dv ? v - v0 : 1 - (v - v0));
      }
    for (std::size_t n = 0; n < known && sum > 0; ++n) {
      const double share = area * shares[n] / sum;
      occupancy[near[n]] += share;
      momentum[near[n]] += share * vx;
      momentum[cells + near[n]] += share * vy;
      agitation[near[n]] += share * square;
      if (is_told) spin[near[n]] += share * turns;
    }
    const double r = std::sqrt(x * x + y * y);
    const double within = std::clamp((r - ring_) / ramp_ + 0.5, 0.0, 1.0);
    if (within == 0) continue;
    const double turn = (std::atan2(y, x) - at.mill_angle) / (2 * kPi) * double(pocket_count);
    const double rounds = std::floor(std::floor(turn) / double(pocket_count));
    const auto pocket = static_cast<std::size_t>(std::floor(turn) - rounds * double(pocket_count));
    pockets[pocket] += area * within;
    pockets[pocket_count + pocket] += area * within * ((x * vy - y * vx) / r - mill_speed * r);
  }
}

void MapSums::finish(std::size_t view, Observation& into) const {
  const Sums& sums = views_[view];
  into.value.resize(layout_->size(), kNotGiven);
  into.noise.resize(layout_->size(), 0);
  const double* const occupancy = sums.values.data() + layout_->first(Observable::kOccupancy);
  const double charge = std::accumulate(occupancy, occupancy + layout_->count(Observable::kOccupancy), 0.0);
  if (!(charge > 0)) return;
  for (const Observable o : {Observable::kOccupancy, Observable::kMomentum, Observable::kAgitation, Observable::kSpin,
                             Observable::kPockets}) {
    double per = 1 / charge;
    // Where only some balls are told of, they stand for all.
    const std::size_t told = o == Observable::kSpin ? sums.spins : sums.squares;
    if (o == Observable::kSpin || o == Observable::kAgitation)
      per *= told > 0 ? double(sums.balls) / double(told) : kNotGiven;
    for (std::size_t k = 0; k < layout_->count(o); ++k)
      into.value[layout_->first(o) + k] = sums.values[layout_->first(o) + k] * per;
  }
}

}  // namespace tumble::diagnose
