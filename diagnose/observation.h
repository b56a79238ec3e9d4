#pragma once
#include <array>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "core/charge_motion.h"

// What a charge in motion comes to for a diagnosis: a row of numbers that are sums over balls and frames. Sums, not
// ratios: a place without balls is 0 and not unknown, and small changes of the motion change all numbers smoothly.
namespace tumble::diagnose {

// Kinds of observables, in the order in which they stand in an Observation.
enum class Observable {
  kTorque,
  kClosure,
  kAngles,
  kOccupancy,
  kMomentum,
  kAgitation,
  kSpin,
  kPockets,
  kFlight,
  kLaws
};
inline constexpr std::array kObservables{
    Observable::kTorque,    Observable::kClosure, Observable::kAngles,  Observable::kOccupancy, Observable::kMomentum,
    Observable::kAgitation, Observable::kSpin,    Observable::kPockets, Observable::kFlight,    Observable::kLaws};
const char* name_of(Observable observable);  // "torque"

inline constexpr int kCells = 12;  // of the lab-fixed maps, along a diameter

// Where which numbers stand. The maps' cells lie within the shell; a mill without lifters has 18 pockets all the same.
struct ObservationLayout {
  explicit ObservationLayout(int lifter_count);

  struct Cell {
    double x, y;  // of the middle [R]
  };
  std::vector<Cell> cells;
  std::vector<int> cell_at;  // of the kCells x kCells grid, row by row from the lowest y; -1 beyond the shell
  int pockets = 0;

  std::size_t first(Observable observable) const;
  std::size_t count(Observable observable) const;
  std::size_t size() const;
  // Where number i comes from: "9 o'clock, at 0.7 R", "lifter 4", "toe_deg".
  std::string region(std::size_t i) const;
  Observable observable_of(std::size_t i) const;
};

// The same numbers, had the drum been turned on by so many lifters before.
std::vector<double> turned_on(const ObservationLayout& layout, std::vector<double> numbers, int lifters);

// Torque [N m of one slice]; torque less M g x_com and dL/dt [N m]; the six toes and shoulders [deg]; each cell's share
// of the charge's area; the same times velocity x, then y [m/s], times the velocity's square [m2/s2], and times spin
// [rad/s]; each drum-fixed pocket's share, then times the balls' speed against the drum along the shell [m/s];
// acceleration of balls in free flight [m/s2]: x, y, and their slopes on velocity; laws of single balls
// (contact_laws.h). NaN where unknown. Shares, so that balls which were not seen now and then are no smaller charge:
// how many there are is told by an exact check.
struct Observation {
  std::vector<double> value;
  std::vector<double> noise;  // standard error by the way it was measured, beside what chance does to the motion itself
};

struct Sighting {
  int ball = 0;
  double x = 0, y = 0;  // [m]
  double radius = 0;    // [m]
  double spin = kNotGiven;
  bool guessed = false;  // not seen, but where its path before and after says that it is
};

// How the observer errs: seen = as it is for all zeros. Artefacts of measurement, applied to what is seen.
struct Observer {
  double scale = 0;     // lengths are seen (1 + scale) times as long
  double rotation = 0;  // everything is seen turned by this, counter-clockwise [rad]
  double clock = 0;     // times are taken as (1 + clock) times as long
};

// How a film looks at the charge. Velocities are displacements over `span` seconds before and after a frame, as a film
// of that spacing shows them: a film of another rate cannot know more. Their squares are products of the velocities in
// the span before and in the span after those: whoever tracks the balls errs in neither the same way.
struct View {
  double span = 0;  // [s]
  Observer observer;
};

// Adds up frames for several views at once: every frame, or every so manieth (`stride`).
class MapSums {
 public:
  MapSums(const ObservationLayout& layout, double mill_radius, double tip_radius, double mean_radius,
          std::vector<View> views, std::size_t stride = 1);

  void add(double time, double mill_angle, std::vector<Sighting> balls);  // times grow; balls by number
  // Fills occupancy, momentum, spin and pockets.
  void finish(std::size_t view, Observation& into) const;

 private:
  struct Seen {
    double time, mill_angle;
    std::vector<Sighting> balls;
  };
  struct Place {
    int ball;
    double x, y;
  };
  struct Moment {
    double time, mill_angle;
    std::vector<Place> places;
  };
  struct Sums {
    View view;
    double cosine, sine, reach;  // reach: the span in true time [s]
    std::vector<double> values;
    std::size_t frames = 0, spins = 0, squares = 0, balls = 0;
  };
  const Moment& moment_at(double time);
  void deposit(Sums& sums, const Seen& at);

  const ObservationLayout* layout_;
  double radius_, ring_, ramp_, longest_ = 0;
  std::vector<Sums> views_;
  std::deque<Seen> window_;
  std::deque<Moment> moments_;  // of the frame that is looked at
  std::size_t stride_ = 1, frames_ = 0;
};

}  // namespace tumble::diagnose
