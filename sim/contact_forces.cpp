#include "sim/contact_forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/kernels/meeting.h"

// Contacts that go on are worked out in blocks by the kernels; those that begin or end, few in a step, one by one.
namespace tumble::sim {
namespace {

// One kind of contacts at one step.
struct Work {
  const RunningMill& mill;
  const ChargeView& balls;
  Patch& patch;
  Share& share;
  Kind kind;
  ContactStep step;
  ShellPose pose;

  bool plain() const { return mill.model.plain(); }
  ContactTable& table() const { return patch.touching[static_cast<std::size_t>(kind)]; }
  NearPairs& near() const { return patch.near[static_cast<std::size_t>(kind)]; }
  ContactSums& sums() const { return kind == Kind::kBalls ? share.at_balls : share.at_wall; }
};

[[noreturn]] void too_deep(const Work& w, int i, int j) {
  const Charge& c = w.mill.charge;
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
  double radius = c.radius[a], overlap = 0;
  std::string other = "the wall";
  if (w.kind == Kind::kBalls) {
    radius = std::min(radius, c.radius[b]);
    overlap = c.radius[a] + c.radius[b] - std::hypot(c.x[b] - c.x[a], c.y[b] - c.y[a]);
    other = fmt::format("ball {}", c.id[b]);
  } else {
    overlap = radius - nearest_on_wall(w.mill.model.shell, w.pose, j, c.x[a], c.y[a]).distance;
  }
  left_physics(w.mill, fmt::format("ball {} overlaps {} by {:.3g} mm, more than half a radius ({:.3g} mm)", c.id[a],
                                   other, 1e3 * overlap, 1e3 * radius / 2));
}

// The forces of a block, or of one contact, into the rows of the balls.
void push(const Work& w, const int* i, const int* j, int n, const Pushes& p) {
  const ForceView rows{w.share.forces.data(), w.share.mask};
  w.mill.kernels->scatter(p.on_i, i, n, rows);
  if (w.kind == Kind::kBalls) w.mill.kernels->scatter(p.on_j, j, n, rows);
}

void push(const Work& w, int i, int j, const Push<double>& p) {
  Pushes one;
  const double sign = w.kind == Kind::kBalls ? -1 : 1;
  Lanes<double>::store_rows(one.on_i, sign * p.fx, sign * p.fy, p.moment_i, p.pressure);
  Lanes<double>::store_rows(one.on_j, p.fx, p.fy, p.moment_j, p.pressure);
  push(w, &i, &j, 1, one);
  w.sums().add({p.normal_loss, p.sliding_loss, p.rolling_loss, p.torque, p.torque_shear});
}

// Where the balls i meet the lifters' runs j, n <= kBlock of them.
void find_points(const Work& w, const int* i, const int* j, int n, WallPoints& points) {
  std::uint64_t unsure = w.mill.kernels->nearest_on_runs(w.balls, w.mill.runs, i, j, n, points);
  for (; unsure != 0; unsure &= unsure - 1) {
    const int b = __builtin_ctzll(unsure);
    const WallPoint p = nearest_on_wall(w.mill.model.shell, w.pose, j[b], w.balls.x[i[b]], w.balls.y[i[b]]);
    points.distance[b] = p.distance;
    points.nx[b] = p.nx;
    points.ny[b] = p.ny;
  }
}

int touching_runs(const Work& w, const NearPairs::Tier& tier, int* hits) {
  WallPoints points;
  int found = 0;
  for (int k = 0; k < tier.count; k += kBlock) {
    const int n = std::min(kBlock, tier.count - k);
    find_points(w, tier.i.data() + k, tier.j.data() + k, n, points);
    for (int b = 0; b < n; ++b)
      if (points.distance[b] < w.balls.radius[tier.i[static_cast<std::size_t>(k + b)]]) hits[found++] = k + b;
  }
  return found;
}

// Contacts that touched at the last step. Those that do no more are left, with their memory, in `parted`.
void go_on(const Work& w) {
  ContactTable& table = w.table();
  const ContactColumns columns = columns_of(table);
  const Kernels& kernels = *w.mill.kernels;
  w.share.parted.clear();
  Pushes out;
  WallPoints points;
  for (int k = 0; k < table.size(); k += kBlock) {
    const int end = std::min(k + kBlock, table.size());
    out.parted = out.too_deep = 0;
    if (w.kind == Kind::kBalls) {
      kernels.balls(w.step, columns, k, end, out, w.sums());
    } else if (w.kind == Kind::kPlate) {
      kernels.plate(w.step, columns, k, end, out, w.sums());
    } else {
      if (w.step.lifters->faces == 0) find_points(w, columns.i + k, columns.j + k, end - k, points);
      kernels.lifters(w.step, columns, k, end, points, out, w.sums());
    }
    if (out.too_deep != 0) {
      const int b = k + __builtin_ctzll(out.too_deep);
      too_deep(w, columns.i[b], columns.j[b]);
    }
    push(w, columns.i + k, columns.j + k, end - k, out);
    for (std::uint64_t bits = out.parted; bits != 0; bits &= bits - 1)
      w.share.parted.push_back(k + __builtin_ctzll(bits));
  }
}

template <bool kPlain>
Meeting<double> meet(const Work& w, int i, int j, WallPoint& at) {
  if (w.kind == Kind::kBalls) return balls_meet<double, kPlain>(w.balls, &i, &j, w.step.time_step);
  at = nearest_on_wall(w.mill.model.shell, w.pose, j, w.balls.x[i], w.balls.y[i]);
  return wall_meets<double, kPlain>(w.balls, &i, w.step.wall, at.distance, at.nx, at.ny, w.step.time_step);
}
Meeting<double> meet(const Work& w, int i, int j, WallPoint& at) {
  Meeting<double> m = w.plain() ? meet<true>(w, i, j, at) : meet<false>(w, i, j, at);
  const double* mass = w.balls.mass;
  m.pair.effective_mass = w.kind == Kind::kBalls ? mass[i] * mass[j] / (mass[i] + mass[j]) : mass[i];
  m.now.damping = w.mill.damping[w.kind != Kind::kBalls].of(m.pair.effective_mass);
  return m;
}

Push<double> push_of(const Work& w, const Meeting<double>& m, const Reaction& r) {
  return w.kind == Kind::kBalls ? push_of_balls(m, r, w.mill.exact) : push_of_wall(m, r, w.mill.exact);
}

std::uint16_t place_of(Face face, double px, double py) {
  const double turn = std::atan2(py, px) / (2 * kPi);
  const int bin = std::min(kAngleBins - 1, static_cast<int>((turn < 0 ? turn + 1 : turn) * kAngleBins));
  return static_cast<std::uint16_t>(static_cast<int>(face) * kAngleBins + bin);
}

void begin(const Work& w, int i, int j) {
  WallPoint at;
  const Meeting<double> m = meet(w, i, j, at);
  if (m.too_deep) too_deep(w, i, j);
  Contact contact{.i = i, .j = j, .damping = m.now.damping, .state = {}, .terms = {}, .place = 0};
  Reaction r;
  if (w.plain()) {
    r = touch(w.step.law->springs, m.now, true, w.step.time_step, contact.state);
  } else {
    contact.terms.damping = damping_from(*w.step.law, m.now, m.pair, w.step.time_step);
    r = touch(*w.step.law, m.now, m.pair, true, w.step.time_step, contact.state, contact.terms);
  }
  if (w.kind != Kind::kBalls) contact.place = place_of(at.face, m.px, m.py);
  add(w.table(), contact, w.kind, w.plain());
  push(w, i, j, push_of(w, m, r));
  w.share.begun.push_back({i, w.kind == Kind::kBalls ? j : -1});
}

// Near pairs that touch now, of the tiers that can.
void begin_new(const Work& w) {
  const Kernels& kernels = *w.mill.kernels;
  const Shell& shell = w.mill.model.shell;
  NearPairs& near = w.near();
  std::vector<int>& hits = w.share.hits;
  const int due = near.due(2 * w.mill.moved);
  for (int t = 0; t < due; ++t) {
    NearPairs::Tier& tier = near.tiers[static_cast<std::size_t>(t)];
    hits.resize(std::max(hits.size(), tier.i.size() + kMostLanes));
    int found = 0;
    if (w.kind == Kind::kBalls) {
      found = kernels.touching_pairs(w.balls, tier.i.data(), tier.j.data(), tier.count, hits.data());
    } else if (w.kind == Kind::kPlate) {
      found = kernels.touching_plate(w.balls, shell.radius, tier.i.data(), tier.count, hits.data());
    } else if (w.step.lifters->faces > 0) {
      found = kernels.touching_lifters(w.balls, *w.step.lifters, tier.i.data(), tier.j.data(), tier.count, hits.data());
    } else {
      found = touching_runs(w, tier, hits.data());
    }
    while (found-- > 0) {  // from the back: the last of the tier fills the gap
      const int k = hits[found];
      begin(w, tier.i[k], tier.j[k]);
      tier.remove(k);
    }
  }
}

void end_parted(const Work& w) {
  ContactTable& table = w.table();
  std::vector<int>& parted = w.share.parted;
  for (auto k = parted.rbegin(); k != parted.rend(); ++k) {
    Contact c = contact_at(table, *k);
    WallPoint at;
    const Meeting<double> m = meet(w, c.i, c.j, at);
    const Reaction r =
        w.plain() ? part(w.step.law->springs, m.now, c.state) : part(*w.step.law, m.now, m.pair, c.state, c.terms);
    const ExactSum& exact = w.mill.exact.loss;
    w.sums().add({exact(r.normal_loss), exact(r.sliding_loss), exact(r.rolling_loss), 0, 0});
    const bool wall = w.kind != Kind::kBalls;
    w.share.ended.push_back({c.i, wall ? -1 : c.j, wall ? c.j : 0, c.place, c.state.normal_lost, c.state.sliding_lost});
    remove(table, *k);
    w.near().add(c.i, c.j, 0);
  }
}

void contacts(const Work& w) {
  go_on(w);
  begin_new(w);
  end_parted(w);
}

// A flight ends with the first contact and begins with the loss of the last one. In between there is no apex to raise.
void land(RunningMill& mill, int ball) {
  const auto i = static_cast<std::size_t>(ball);
  if (mill.flights.contacts[i]++ > 0) return;
  const double height = mill.flights.apex[i] - mill.charge.y[i];
  mill.flights.apex[i] = std::numeric_limits<double>::max();
  if (!mill.ledger.counting_impacts) return;
  const int bin = static_cast<int>(kFallBins * height / (2 * mill.model.shell.radius));
  mill.ledger.impacts.falls[static_cast<std::size_t>(std::clamp(bin, 0, kFallBins - 1))] += 1;
}
void leave(RunningMill& mill, int ball) {
  const auto i = static_cast<std::size_t>(ball);
  if (--mill.flights.contacts[i] == 0) mill.flights.apex[i] = mill.charge.y[i];
}

void count_impact(RunningMill& mill, const Ended& e) {
  Impacts& impacts = mill.ledger.impacts;
  if (e.j >= 0) {
    impacts.ball_ball.add(e.normal_lost, e.sliding_lost);
    return;
  }
  const double lost = e.normal_lost + e.sliding_lost;
  impacts.ball_wall.add(e.normal_lost, e.sliding_lost);
  impacts.wall_number[e.place] += 1;
  impacts.wall_energy[e.place] += lost;
  if (e.feature == 0) return;
  const auto lifter = static_cast<std::size_t>(lifter_of(mill.model.shell, e.feature));
  impacts.lifter_number[lifter] += 1;
  impacts.lifter_energy[lifter] += lost;
}

}  // namespace

void contact_forces(const RunningMill& mill, const ChargeView& balls, Patch& patch, Share& share) {
  const MillModel& m = mill.model;
  const ShellPose pose = pose_of(mill_angle(m, mill.step));
  const double speed = mill_speed(m, mill.step), speed_before = mill_speed_before(m, mill.step);
  const ContactStep between{&m.ball, &balls, &mill.exact, m.time_step, {}, nullptr};
  const ContactStep at_wall{
      &m.wall, &balls, &mill.exact, m.time_step, {m.shell.radius, speed_before, speed - speed_before}, &mill.lifters};
  contacts({mill, balls, patch, share, Kind::kBalls, between, pose});
  contacts({mill, balls, patch, share, Kind::kPlate, at_wall, pose});
  contacts({mill, balls, patch, share, Kind::kLifters, at_wall, pose});
}

void book_events(RunningMill& mill) {
  // What begins comes first: a ball that passes from one contact to another does not fly.
  for (const Share& share : mill.shares)
    for (const Begun& b : share.begun) {
      land(mill, b.i);
      if (b.j >= 0) land(mill, b.j);
    }
  std::vector<Ended>& at_wall = mill.ended_at_wall;
  at_wall.clear();
  for (const Share& share : mill.shares)
    for (const Ended& e : share.ended) {
      leave(mill, e.i);
      if (e.j >= 0) leave(mill, e.j);
      if (!mill.ledger.counting_impacts) continue;
      if (e.j >= 0)
        count_impact(mill, e);
      else
        at_wall.push_back(e);
    }
  // Energies are summed up over the whole run, in an order that does not hang on how the balls are stored.
  std::sort(at_wall.begin(), at_wall.end(), [&](const Ended& a, const Ended& b) {
    const int ia = mill.charge.id[static_cast<std::size_t>(a.i)], ib = mill.charge.id[static_cast<std::size_t>(b.i)];
    return ia != ib ? ia < ib : a.feature < b.feature;
  });
  for (const Ended& e : at_wall) count_impact(mill, e);
}

}  // namespace tumble::sim
