#pragma once
#include <array>
#include <deque>
#include <span>
#include <vector>

#include "core/config.h"
#include "core/mill_shape.h"
#include "diagnose/observation.h"

// What happens to single balls, found in positions alone: flights of balls that touch nothing, and impacts of two
// balls, or of a ball and the shell between its lifters, that touch nothing else for a while before and after. An
// impact is where two straight paths (parabolas at the wall) meet; a contact that is not seen as such is left out.
namespace tumble::diagnose {

struct FlightWindow {  // a piece of one flight, by least squares
  double time = 0;     // of its middle [s]
  double radius = 0, mass = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  // in its middle [m], [m/s]
  double ax = 0, ay = 0;                // [m/s2]
  double information = 0;               // variance of a place over that of an acceleration [1/s4]
  double half = 0;                      // of its duration [s]
  double spin = kNotGiven;              // mean [rad/s]
  double spin_slope = kNotGiven;        // [rad/s2]
  double spin_information = 0;          // variance of a spin over that of its slope [s2]
  double scatter = 0;                   // of the places about the parabola [m]
  int freedom = 0;                      // of that
};

// Body j against body i, as everywhere: n from i to j or into the wall, t is n turned counter-clockwise.
struct SeenImpact {
  double time = 0;
  bool at_wall = false;
  double radius_i = 0, radius_j = 0, mass_i = 0, mass_j = 0;  // those of j unknown at the wall

  // Velocities along n and t, seen in all frames before and, apart, in every other one: those have errors of their own,
  // so that impacts can be chosen by one and measured by another. At the wall: without the fall in between.
  struct View {
    double closing = 0, sliding = 0;        // before [m/s]
    double parting = 0, sliding_after = 0;  // after, along the same n
    double lag = 0;                         // from the middle of those frames to the impact [s]
    double spread = 0;                      // sum of the frames' squared times from their middle [s2]
    double nx = 0, ny = 0;
  };
  View all;
  std::array<View, 2> half;
  double lag_after = 0, spread_after = 0;

  double spin_i = kNotGiven, spin_j = kNotGiven;              // before [rad/s]
  double spin_i_after = kNotGiven, spin_j_after = kNotGiven;  // [rad/s]
  double spin_lag = 0, spin_lag_after = 0;  // from the middle of the frames that these are from to the impact [s]
  double wall_speed = 0;                    // of the shell along t [m/s]
  double scatter = 0;                       // of the places about the paths [m]
  int freedom = 0;                          // of that
  double miss = 0;   // by how much the paths meet farther out than bodies of these radii touch [m]
  double stray = 0;  // velocity that the pair's middle has gained from elsewhere [m/s]
};

// Of the balls' classes, by number [m].
double mean_radius(std::span<const BallClass> classes);

class ContactEvents {
 public:
  explicit ContactEvents(const Config& config);  // shape, classes of balls, speed

  // Times grow; balls by number. `mill_angle` NaN: nothing is known of lifters, and wall impacts are not looked for.
  void add(double time, double mill_angle, std::span<const Sighting> balls);
  // Those that are to be believed: paths as straight as the others', nothing gained from elsewhere.
  std::vector<FlightWindow> flights() const;
  // Spins of impacts are those at the touch: what is lost on the way is known from flights.
  std::vector<SeenImpact> impacts() const;

 private:
  struct Body {
    Sighting seen;
    int near = 0, partner = -1;  // balls within the clearance; one of them
    bool lonely = true;          // nothing within twice the clearance
    bool within_reach = false;   // of another ball, before the next frame
    bool at_plate = false, at_lifter = false;
    double wall_gap = 0;
  };
  struct Pair {
    std::size_t a = 0, b = 0;
    double gap = 0;
  };
  struct Moment {
    double time = 0, mill_angle = 0;
    std::vector<Body> bodies;
    std::vector<Pair> pairs;  // that may be about to touch
  };
  struct Flight {
    int ball = 0;
    int skip = 0;  // frames that are still to be left out
    double last = 0, radius = 0;
    std::vector<double> t = {}, x = {}, y = {}, spin = {};
  };
  struct Piece;

  Moment look(double time, double mill_angle, std::span<const Sighting> balls) const;
  bool near_lifter(const Sighting& ball, double mill_angle, double reach) const;
  void fly(const Moment& now);
  void close(Flight& flight, int left_out);
  void search();
  void measure(int i, int j);
  double mass_of(double radius) const;
  double spin_decay() const;
  static const Body* find(const Moment& moment, int ball);

  MillShape shape_;
  std::vector<BallClass> classes_;
  double mill_speed_ = 0, mean_radius_ = 0;
  std::size_t reach_ = 0;  // frames before and after an impact that are looked at; 0 until the rate is known
  double spacing_ = 0;     // of the frames [s]
  std::deque<Moment> moments_;
  std::vector<Flight> open_;  // by ball
  std::vector<FlightWindow> flights_;
  std::vector<SeenImpact> impacts_;
};

}  // namespace tumble::diagnose
