#include "analysis/bed_times.h"

#include <algorithm>

#include "analysis/flights.h"
#include "core/units.h"

namespace tumble::analysis {

BedTimes::BedTimes(const ChargeMotion& motion) {
  FlightLog log(kGravity);
  std::vector<TrackPoint> frame;
  int last = -1;
  for (const TrackPoint& p : motion.tracks) {
    if (!frame.empty() && p.frame != frame.back().frame) {
      log.add(frame);
      frame.clear();
    }
    if (last < 0) begin_ = p.time;
    last = std::max(last, p.id);
    frame.push_back(p);
  }
  if (!frame.empty()) log.add(frame);
  flights_.resize(static_cast<std::size_t>(last + 1));
  for (const Flight& f : log.finish()) flights_[static_cast<std::size_t>(f.id)].push_back({f.start_time, f.end_time});
  for (auto& of_ball : flights_)
    std::sort(of_ball.begin(), of_ball.end(), [](const Span& a, const Span& b) { return a.from < b.from; });
}

double BedTimes::residence(std::size_t ball, double time) const {
  if (ball >= flights_.size()) return kNotGiven;
  const auto& flights = flights_[ball];
  const auto next = std::upper_bound(flights.begin(), flights.end(), time,
                                     [](double t, const Span& flight) { return t < flight.from; });
  return std::max(0.0, time - (next == flights.begin() ? begin_ : (next - 1)->to));
}

std::vector<double> BedTimes::stays() const {
  std::vector<double> lengths;
  for (const auto& of_ball : flights_)
    for (std::size_t k = 1; k < of_ball.size(); ++k)
      lengths.push_back(std::max(0.0, of_ball[k].from - of_ball[k - 1].to));
  return lengths;
}

}  // namespace tumble::analysis
