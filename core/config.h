#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

// What MILL.toml says, nested as the file is nested. Numbers that were not given are NaN (or nullopt): `analyse`
// works with a partial file. `check_complete` is what a simulation asks for.
namespace tumble {

inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();
inline double or_nothing(double value) { return value == value ? value : 0; }  // 0 where it is not given

enum class LifterProfile { kNone, kRectangle, kTriangle, kTrapezoid, kWave, kPolygon, kSwivel };
enum class ContactLaw { kLinear, kHertz };

struct Lifters {
  int count = 0;  // number of lifters round the shell, >= 1 unless profile is none
  LifterProfile profile = LifterProfile::kNone;
  double height = kNotGiven;              // above the shell, along the radius [m], > 0
  double width = kNotGiven;               // at the foot, across the radius [m], > 0
  double leading_angle_deg = kNotGiven;   // leading face against the radius, 0 = radial, [0, 85]
  double trailing_angle_deg = kNotGiven;  // trailing face against the radius, [0, 85]
  double swivel_angle_deg = kNotGiven;    // swivel: the bar's tilt, > 0 back against the rotation, [-60, 60]
  // polygon: the outline from the trailing foot over the top to the leading foot, { height above the shell, across }
  // [m]
  std::vector<std::array<double, 2>> points;
};

struct Mill {
  double diameter = kNotGiven;            // D, inside the shell [m], > 0
  double length = kNotGiven;              // inside the mill, for scaling one slice to the mill [m], > 0
  double speed = kNotGiven;               // fraction of critical speed, >= 0; excludes speed_rpm
  double speed_rpm = kNotGiven;           // [rev/min], >= 0
  double critical_speed_rpm = kNotGiven;  // overrides (30/pi) sqrt(g / R) [rev/min], > 0
  std::optional<int> slices;              // slices that make up the mill, >= 1
  Lifters lifters;
};

struct BallClass {
  double radius = kNotGiven;  // r [m], > 0
  double mass = kNotGiven;    // m [kg], > 0; given, or from density as a sphere
  double share = 1.0;         // of the number of balls, > 0 (normalised over the classes)
};

struct ChargeMix {
  double filling = kNotGiven;    // J = disc area / (0.82 x shell area), (0, 0.8]; excludes count
  std::optional<int> count;      // number of balls in the slice, >= 1
  double bulk_density = 4700.0;  // of the settled charge, voids included [kg/m3]
  std::vector<BallClass> balls;
};

struct WallContact {                        // what is not given equals the value between balls
  double normal_stiffness = kNotGiven;      // [N/m], > 0
  double tangential_stiffness = kNotGiven;  // [N/m], >= 0
  double friction = kNotGiven;              // >= 0
  double restitution = kNotGiven;           // (0, 1]
};

struct Contact {
  ContactLaw law = ContactLaw::kLinear;
  double normal_stiffness = 4e5;      // k_n [N/m], > 0 (Mishra & Rajamani 1992, Table 3)
  double tangential_stiffness = 3e5;  // k_t [N/m], >= 0
  double friction = 0.2;              // mu, ball on ball, >= 0
  double restitution = 0.8;           // e, ball on ball, (0, 1]
  // Share of every friction that is lost at critical speed, linear in the speed: mu (1 - drop phi), >= 0 (1992 paper,
  // p. 603, for swivel and triangular lifters), [0, 1].
  double friction_drop_at_critical = 0;
  WallContact wall;
};

struct RunPlan {
  double spin_up = 2.0;              // revolutions before anything is averaged, >= 0; used unless spin_up_auto
  bool spin_up_auto = false;         // run until the averages are steady
  double revolutions = 6.0;          // averaged and written, > 0
  double frames_per_second = 200.0;  // written frames per simulated second, > 0
  double time_step = kNotGiven;      // dt [s]; NaN = from the stability limit
  std::uint64_t seed = 1;            // of the packing
};

// [measurement]: how what was measured on this mill errs, for those who compare with it; a simulation is as without.
struct MeasurementErrors {
  double camera_scale = kNotGiven;         // lengths in films and tracks over the true ones, less 1, [-0.5, 1]
  double camera_rotation_deg = kNotGiven;  // films and tracks are turned by this, counter-clockwise, [-180, 180]
  double frame_clock = kNotGiven;          // times in films and tracks over the true ones, less 1, [-0.5, 1]
  double torque_offset_N_m = kNotGiven;    // measured less true, of the whole mill
  double filling_error = kNotGiven;        // true fillings over those that experiments set, less 1, [-0.5, 1]
  double speed_error = kNotGiven;          // true speeds over those that experiments set, less 1, [-0.5, 1]
};

// [effects.NAME]: what was given of each effect; its meaning is core/effects.h's.
using EffectSettings = std::map<std::string, std::vector<double>>;  // parameter -> value, or the values of a list

struct Config {
  Mill mill;
  ChargeMix charge;
  Contact contact;
  std::map<std::string, EffectSettings> effects;
  RunPlan run;
  MeasurementErrors measurement;

  // Where a key was set ("mill.toml:12" or "--set"), for messages; keys that were left at their default are absent.
  std::map<std::string, std::string> origin;
  std::string file = "MILL.toml";  // named in messages about keys that are missing
};

// "mill.toml:12: mill.diameter", for InputError's place.
std::string place_of(const Config& config, const std::string& key);

// Throws InputError on a value out of its range or at odds with another, naming place, value and remedy.
// check() accepts what is not given; check_complete() also asks for all that a simulation needs.
void check(const Config& config);
void check_complete(const Config& config);

// The speeds, whichever way they were given.
double critical_speed_rpm(const Mill& mill);  // N_c = (30/pi) sqrt(g / R)
double speed_rpm(const Mill& mill);
double speed_fraction(const Mill& mill);

// The contact parameters in force at this mill speed; at the wall, what was not given is taken from between balls.
Contact ball_contact(const Config& config);
Contact wall_contact(const Config& config);

// Number of balls of each class: by `count`, or the number whose disc area comes nearest to `filling`; classes by
// largest remainder of the shares.
std::vector<int> class_counts(const Config& config);

// Filling J and mass [kg] of the slice with these class counts.
double filling_of(const Config& config, const std::vector<int>& counts);
double slice_mass(const Config& config, const std::vector<int>& counts);

// How many slices make up the mill, not rounded, and by which rule.
enum class SliceRule {
  kGiven,     // mill.slices
  kNoLength,  // 1: the slice is all that is known
  kThin,      // 1: the length is below 1.5 number-mean ball diameters
  kWeight,    // J x shell area x length x bulk density / slice mass (Mishra & Rajamani 1992, p. 603)
};
SliceRule slice_rule(const Config& config);
double slice_count(const Config& config);

const char* name_of(LifterProfile profile);
const char* name_of(ContactLaw law);

}  // namespace tumble
