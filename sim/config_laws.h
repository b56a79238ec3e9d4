#pragma once
#include <array>
#include <memory>

#include "core/config.h"

// The laws that a config stands for, asked one by one: for those who measure a law and want to draw the model's over
// it.
namespace tumble::sim {

class ConfigLaws {
 public:
  explicit ConfigLaws(const Config& config);  // complete; throws as simulate does
  ~ConfigLaws();
  ConfigLaws(ConfigLaws&&) noexcept;

  // Of an impact with this normal speed at first touch [m/s].
  double restitution(bool at_wall, double normal_speed) const;
  // Coulomb's coefficient of a contact that slides at this speed [m/s].
  double friction(bool at_wall, double sliding_speed) const;

  // One impact, stepped through as in a run but alone; the mean over where in a step the touch falls. Body j moves
  // against body i: n from i to j or into the wall, t is n turned counter-clockwise. At the wall mass_j and radius_j
  // are not looked at.
  struct Meeting {
    bool at_wall = false;
    double mass_i = 0, radius_i = 0, mass_j = 0, radius_j = 0;
    double closing = 0;  // > 0 [m/s]
    double slip = 0;     // of the contact points along t [m/s]
    double roll = 0;     // spin of j less that of i [rad/s]
  };
  struct Parting {
    double parting = 0;  // [m/s]
    double sliding = 0;  // change of the middles' velocity along t [m/s]
    double couple = 0;   // impulse against rolling on j, less on i [N m s]
  };
  Parting rebound(const Meeting& meeting) const;

  // What a ball feels that touches nothing, beside gravity: fluids, pool, end walls [m/s2].
  struct Flying {
    double radius, mass, x, y, vx, vy;
  };
  std::array<double, 2> acceleration(const Flying& ball) const;
  double spin_decay(const Flying& ball) const;  // rate at which fluids take its spin [1/s]
  double mill_speed() const;                    // the mean over a revolution [rad/s]

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::sim
