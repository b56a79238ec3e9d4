#include "diagnose/law_samples.h"

#include <cmath>

#include "core/units.h"

namespace tumble::diagnose {
namespace {

constexpr double kSureToSlide = 1.3;  // times the slip that friction takes away in the impact

// Velocities of one impact at the touch, by one choice of the frames before it.
struct Rebound {
  double closing, parting, sliding, sliding_after;
};

Rebound rebound_of(const SeenImpact& e, const SeenImpact::View& v, const Observer& o) {
  const double faster = (1 + o.scale) / (1 + o.clock);
  Rebound r{v.closing * faster, v.parting * faster, v.sliding * faster, v.sliding_after * faster};
  if (!e.at_wall) return r;
  const double c = std::cos(o.rotation), s = std::sin(o.rotation), nx = c * v.nx - s * v.ny, ny = s * v.nx + c * v.ny;
  const double before = kGravity * v.lag * (1 + o.clock), after = kGravity * e.lag_after * (1 + o.clock);
  r.closing -= before * ny;
  r.sliding += before * nx;
  r.parting -= after * ny;
  r.sliding_after -= after * nx;
  return r;
}

double slip_of(const SeenImpact& e, const Rebound& r, const Observer& o) {
  const double turning = (e.radius_i * e.spin_i + (e.at_wall ? 0 : e.radius_j * e.spin_j)) / (1 + o.clock);
  return r.sliding + (e.at_wall ? e.wall_speed * (1 + o.scale) / (1 + o.clock) : 0) - turning;
}

// The same impact as the model has it; a ball whose spin is not seen is taken to roll.
sim::ConfigLaws::Parting by_model(const sim::ConfigLaws& model, const SeenImpact& e, const Rebound& r) {
  const double slip = slip_of(e, r, {}), roll = e.spin_j - e.spin_i;
  return model.rebound({e.at_wall, e.mass_i, e.radius_i, e.mass_j, e.radius_j, r.closing,
                        std::isfinite(slip) ? slip : 0, std::isfinite(roll) ? roll : 0});
}

double spread_of(const SeenImpact& e, const SeenImpact::View& v) { return 1 / (1 / v.spread + 1 / e.spread_after); }

void add_restitution(std::vector<LawSample>& out, int event, const SeenImpact& e, const sim::ConfigLaws* model,
                     const Observer& o) {
  for (std::size_t g = 0; g < 2; ++g) {
    const Rebound chosen = rebound_of(e, e.half[1 - g], o), r = rebound_of(e, e.half[g], o);
    const double weight = spread_of(e, e.half[g]);
    LawSample s{event, chosen.closing, r.closing, weight * r.parting, weight * r.closing, 0};
    if (model && r.closing > 0) s.model = weight * by_model(*model, e, r).parting;
    out.push_back(s);
  }
}

// A sphere's contact point loses 7/2 of what friction takes from the relative velocity of the middles.
void add_friction(std::vector<LawSample>& out, int event, const SeenImpact& e, const Config& config,
                  const sim::ConfigLaws* model, const Observer& o) {
  const Rebound r = rebound_of(e, e.all, o);
  const double slip = slip_of(e, r, o), kick = r.closing + r.parting;
  if (!(kick > 0)) return;
  const double usual = e.at_wall ? wall_contact(config).friction : ball_contact(config).friction;
  const double lost = 3.5 * usual * kick;
  if (!(std::abs(slip) > kSureToSlide * lost)) return;
  const double weight = spread_of(e, e.all), x = std::abs(slip) - 0.5 * lost;
  LawSample s{event, x, x, -std::copysign(weight, slip) * (r.sliding_after - r.sliding), weight * kick, 0};
  if (model && r.closing > 0) s.model = -std::copysign(weight, slip) * by_model(*model, e, r).sliding;
  out.push_back(s);
}

// Of the two spins' changes the part that friction has no hand in.
void add_rolling(std::vector<LawSample>& out, int event, const SeenImpact& e, const sim::ConfigLaws* model,
                 const Observer& o) {
  const double per_clock = 1 / (1 + o.clock), roll = (e.spin_j - e.spin_i) * per_clock;
  const Rebound r = rebound_of(e, e.all, o);
  const double kick = (r.closing + r.parting) * e.mass_i * e.mass_j / (e.mass_i + e.mass_j);
  const double change_i = (e.spin_i_after - e.spin_i) * per_clock, change_j = (e.spin_j_after - e.spin_j) * per_clock;
  if (!std::isfinite(change_i + change_j) || !(kick > 0)) return;
  const double inertia_i = 0.4 * e.mass_i * e.radius_i * e.radius_i,
               inertia_j = 0.4 * e.mass_j * e.radius_j * e.radius_j, reach = e.radius_i + e.radius_j;
  const double couple = (e.radius_i * inertia_j * change_j - e.radius_j * inertia_i * change_i) / reach;
  const double down = kick * e.radius_i * e.radius_j / reach;
  LawSample s{event, std::abs(roll), std::abs(roll), -std::copysign(1.0, roll) * couple, down, 0};
  if (model && r.closing > 0) s.model = -std::copysign(1.0, roll) * by_model(*model, e, r).couple;
  out.push_back(s);
}

void add_flight(std::vector<LawSample>& out, int event, Law law, const FlightWindow& w, const Config& config,
                const sim::ConfigLaws* model) {
  if (law == Law::kSpinDecay) {
    if (!std::isfinite(w.spin + w.spin_slope)) return;
    const double size = w.spin_information * w.spin * w.spin, turns = std::abs(w.spin);
    const double own = model ? model->spin_decay({w.radius, w.mass, w.x, w.y, w.vx, w.vy}) : 0;
    out.push_back({event, turns, turns, -w.spin_information * w.spin * w.spin_slope, size, size * own});
    return;
  }
  std::array<double, 2> own{};
  if (model)
    own = mean_over<std::array<double, 2>>(w, [&](double x, double y, double vx, double vy) {
      return model->acceleration({w.radius, w.mass, x, y, vx, vy});
    });
  const double turn = rad_s_from_rpm(speed_rpm(config.mill));
  double dx = w.vx, dy = w.vy, key = 0;  // against which the force acts
  if (law == Law::kEnds) dx += turn * w.y, dy -= turn * w.x;
  const double length = std::hypot(dx, dy);
  dx /= -length;
  dy /= -length;
  key = length;
  if (law == Law::kLift) {
    dx = 0;
    dy = 1;
    key = w.y / (config.mill.diameter / 2);
  }
  const double along = dx * w.ax + dy * (w.ay + kGravity);
  out.push_back({event, key, key, w.information * along, w.information, w.information * (dx * own[0] + dy * own[1])});
}

}  // namespace

FlightWindow seen_by(const Observer& o, FlightWindow w) {
  const double longer = 1 + o.scale, slower = 1 + o.clock, c = std::cos(o.rotation), s = std::sin(o.rotation);
  const auto turn = [&](double& x, double& y, double by) {
    const double turned = by * (c * x - s * y);
    y = by * (s * x + c * y);
    x = turned;
  };
  turn(w.x, w.y, longer);
  turn(w.vx, w.vy, longer / slower);
  turn(w.ax, w.ay, longer / (slower * slower));
  w.half *= slower;
  w.spin /= slower;
  w.spin_slope /= slower * slower;
  w.spin_information *= slower * slower;
  return w;
}

std::vector<LawSample> samples_of(Law law, std::span<const FlightWindow> flights, std::span<const SeenImpact> impacts,
                                  const Config& config, const sim::ConfigLaws* model, const Observer& observer) {
  std::vector<LawSample> out;
  if (law == Law::kDrag || law == Law::kLift || law == Law::kEnds || law == Law::kSpinDecay) {
    for (std::size_t k = 0; k < flights.size(); ++k)
      add_flight(out, static_cast<int>(k), law, seen_by(observer, flights[k]), config, model);
    return out;
  }
  const bool at_wall = law == Law::kWallRestitution || law == Law::kWallFriction;
  for (std::size_t k = 0; k < impacts.size(); ++k) {
    const SeenImpact& e = impacts[k];
    const int event = static_cast<int>(k);
    if (e.at_wall != at_wall) continue;
    if (law == Law::kRolling)
      add_rolling(out, event, e, model, observer);
    else if (law == Law::kBallFriction || law == Law::kWallFriction)
      add_friction(out, event, e, config, model, observer);
    else
      add_restitution(out, event, e, model, observer);
  }
  return out;
}

}  // namespace tumble::diagnose
