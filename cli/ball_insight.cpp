#include "cli/ball_insight.h"

#include <algorithm>
#include <tuple>

#include "core/quantile.h"

namespace tumble::cli {
namespace {

// Every contact of either list, its force `share` of the way from a to b; both are in order of i, then j, with the
// shell last. A ball that touches the shell twice keeps both.
std::vector<ContactForce> blended(const std::vector<ContactForce>& a, const std::vector<ContactForce>& b,
                                  double share) {
  const auto key = [](const ContactForce& c) { return std::tuple(c.j < 0, c.i, c.j); };
  std::vector<ContactForce> both;
  auto p = a.begin(), q = b.begin();
  while (p != a.end() || q != b.end()) {
    if (q == b.end() || (p != a.end() && key(*p) < key(*q))) {
      both.push_back(*p++);
      both.back().normal *= 1 - share;
    } else if (p == a.end() || key(*q) < key(*p)) {
      both.push_back(*q++);
      both.back().normal *= share;
    } else {
      const auto mix = [share](double from, double to) { return from + share * (to - from); };
      both.push_back({p->i, p->j, mix(p->x, q->x), mix(p->y, q->y), mix(p->normal, q->normal)});
      ++p;
      ++q;
    }
  }
  return both;
}

}  // namespace

BallInsight::BallInsight(const io::RunReader& run, const ChargeMotion& truth, const render::Style& style)
    : run_(run), style_(style) {
  if (render::shows_forces(style)) forces_.emplace(run.setup());
  if (render::shows_residence(style)) bed_.emplace(truth);
}

const std::vector<ContactForce>& BallInsight::stored(std::size_t frame) {
  Stored& kept = stored_[frame % 2];
  if (kept.frame != frame) kept = {frame, forces_->at(run_.frame(frame))};
  return kept.contacts;
}

BallInsight::Moment BallInsight::at(double time) {
  Moment moment;
  const std::size_t balls = run_.setup().balls.size();
  if (forces_) {
    const std::vector<double>& times = run_.time();
    const auto after = std::upper_bound(times.begin(), times.end(), time + 1e-9);
    const std::size_t i = after == times.begin() ? 0 : static_cast<std::size_t>(after - times.begin()) - 1;
    const double share = i + 1 < times.size() ? std::clamp((time - times[i]) / (times[i + 1] - times[i]), 0.0, 1.0) : 0;
    moment.contacts = share > 1e-6 ? blended(stored(i), stored(i + 1), share) : stored(i);
    if (style_.colour == render::Colour::kForce) moment.of_ball = largest_forces(moment.contacts, balls);
  }
  if (bed_)
    for (std::size_t ball = 0; ball < balls; ++ball) moment.of_ball.push_back(bed_->residence(ball, time));
  return moment;
}

double BallInsight::residence_top() const {
  const double usual = quantile_of(bed_->stays(), 0.95);
  return usual > 0 ? usual : std::max(run_.time().back() - run_.time().front(), 1e-3);
}

double BallInsight::force_top() {
  std::vector<double> forces;
  const std::size_t step = std::max<std::size_t>(1, run_.frame_count() / 50);
  for (std::size_t i = 0; i < run_.frame_count(); i += step)
    for (const ContactForce& c : stored(i)) forces.push_back(c.normal);
  return forces.empty() ? 1 : std::max(quantile_of(std::move(forces), 0.99), 1e-3);
}

}  // namespace tumble::cli
