#include "sim/frame_forces.h"

#include <cfloat>
#include <cmath>

#include "sim/cell_grid.h"
#include "sim/charge.h"
#include "sim/mill_model.h"

namespace tumble::sim {

struct FrameForces::Impl {
  explicit Impl(const RunSetup& setup)
      : model(make_mill_model(setup.config)),
        damping{Damping(model.ball.springs, model.time_step), Damping(model.wall.springs, model.time_step)},
        charge(make_charge(setup.balls)),
        shallowest(2 * FLT_EPSILON * model.shell.radius) {
    for (const double r : charge.radius) largest = std::max(largest, r);
  }

  double normal_force(const ContactModel& law, double overlap, double closing, const Damping& loss,
                      const Pairing& pair) const {
    const Touch now{overlap, closing, closing * model.time_step, 0, loss.of(pair.effective_mass)};
    ContactState state;
    TermState terms;
    terms.damping = damping_from(law, now, pair, model.time_step);
    return touch(law, now, pair, false, model.time_step, state, terms).normal;
  }

  void add_balls(std::vector<ContactForce>& out);
  void add_wall(const Frame& frame, std::vector<ContactForce>& out);

  MillModel model;
  Damping damping[2];  // of a ball on a ball, on the wall
  Charge charge;
  CellGrid grid;
  double shallowest, largest = 0;  // overlap, radius [m]
  std::vector<int> partners;
  std::vector<NearFeature> near;
};

void FrameForces::Impl::add_balls(std::vector<ContactForce>& out) {
  const Charge& c = charge;
  if (c.size() == 0) return;
  grid.fill(c, 2 * largest);
  for (std::size_t i = 0; i < c.size(); ++i) {
    grid.partners_of(c, static_cast<int>(i), 0, partners);
    for (const int partner : partners) {
      const auto j = static_cast<std::size_t>(partner);
      const double dx = c.x[j] - c.x[i], dy = c.y[j] - c.y[i], d = std::hypot(dx, dy);
      const double reach = c.radius[i] + c.radius[j], overlap = reach - d;
      if (overlap <= shallowest) continue;
      const double nx = dx / d, ny = dy / d;
      const double closing = -((c.vx[j] - c.vx[i]) * nx + (c.vy[j] - c.vy[i]) * ny);
      const Pairing pair{c.mass[i] * c.mass[j] / (c.mass[i] + c.mass[j]), c.radius[i] * c.radius[j] / reach, 0};
      const double arm = c.radius[i] - 0.5 * overlap;
      out.push_back({static_cast<int>(i), partner, c.x[i] + arm * nx, c.y[i] + arm * ny,
                     normal_force(model.ball, overlap, closing, damping[0], pair)});
    }
  }
}

void FrameForces::Impl::add_wall(const Frame& frame, std::vector<ContactForce>& out) {
  const Charge& c = charge;
  const ShellPose pose = pose_of(frame.mill_angle);
  const double speed = mill_speed(model, frame.step);
  for (std::size_t i = 0; i < c.size(); ++i) {
    near.clear();
    features_near(model.shell, pose, c.x[i], c.y[i], c.radius[i], near);
    for (const NearFeature& feature : near) {
      const WallPoint p = nearest_on_wall(model.shell, pose, feature.feature, c.x[i], c.y[i]);
      const double overlap = c.radius[i] - p.distance;
      if (overlap <= shallowest) continue;
      const double px = c.x[i] + p.distance * p.nx, py = c.y[i] + p.distance * p.ny;
      const double closing = -((-speed * py - c.vx[i]) * p.nx + (speed * px - c.vy[i]) * p.ny);
      out.push_back({static_cast<int>(i), -1, px, py,
                     normal_force(model.wall, overlap, closing, damping[1], {c.mass[i], c.radius[i], 0})});
    }
  }
}

FrameForces::FrameForces(const RunSetup& setup) : impl_(std::make_unique<Impl>(setup)) {}
FrameForces::~FrameForces() = default;
FrameForces::FrameForces(FrameForces&&) noexcept = default;

std::vector<ContactForce> FrameForces::at(const Frame& frame) {
  Impl& my = *impl_;
  my.charge.x = frame.x;
  my.charge.y = frame.y;
  my.charge.vx = frame.vx;
  my.charge.vy = frame.vy;
  std::vector<ContactForce> contacts;
  my.add_balls(contacts);
  my.add_wall(frame, contacts);
  return contacts;
}

}  // namespace tumble::sim
