// Simulated drums beside measured ones, from MOTION.h5 (`tumble analyse RUN.h5 -o MOTION.h5`):
//   drum_flow surface MOTION.h5 SURFACE.csv PROFILES.csv SPEED_RPM    the free surface (GranuDrum photographs)
//   drum_flow depth MOTION.h5 VELOCITIES.csv                         velocity against depth (particle tracking)
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <vector>

#include "core/angle.h"
#include "core/error.h"
#include "io/csv_file.h"
#include "io/motion_file.h"

using namespace tumble;

namespace {

// Half of what a settled bed covers: the grey half way between bed and air in an averaged photograph.
constexpr double kEdge = kSettledAreaShare / 2;

// A field's value between the cells' centres; NaN outside the grid.
double at(const Field& f, const std::vector<double>& values, double x, double y) {
  const double u = x / f.cell + f.n / 2.0 - 0.5, v = y / f.cell + f.n / 2.0 - 0.5;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  if (i < 0 || j < 0 || i + 1 >= f.n || j + 1 >= f.n) return kNotGiven;
  const auto value = [&](int a, int b) { return values[static_cast<std::size_t>(b * f.n + a)]; };
  const double s = u - i, t = v - j;
  return (1 - t) * ((1 - s) * value(i, j) + s * value(i + 1, j)) +
         t * ((1 - s) * value(i, j + 1) + s * value(i + 1, j + 1));
}

// Height of the free surface over x, going up from inside the bed; NaN where there is none.
double surface(const ChargeMotion& m, double x) {
  const double step = m.field.cell / 20,
               bottom = -std::sqrt(std::max(0.0, 0.9 * m.mill_radius * m.mill_radius - x * x));
  bool in_bed = false;
  for (double y = bottom; y < -bottom; y += step) {
    const double covered = at(m.field, m.field.occupancy, x, y);
    if (covered >= kEdge) in_bed = true;
    if (in_bed && covered < kEdge) return y;
  }
  return kNotGiven;
}

// Where the surface meets the circle of 0.96 R, in degrees; `from` inside the bed, `step` towards toe (-) or shoulder
// (+).
double end_of_bed(const ChargeMotion& m, double from, double step) {
  const double r = 0.96 * m.mill_radius - 0.5 * m.field.cell;  // the outer cells reach beyond the shell
  for (double a = from; std::abs(a - from) < 180; a += step)
    if (at(m.field, m.field.occupancy, r * std::cos(radians(a)), r * std::sin(radians(a))) < kEdge) return wrap_360(a);
  return kNotGiven;
}

struct Line {
  double slope_deg = 0, height = 0;
};
Line middle_of_surface(const ChargeMotion& m) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
  for (double x = -0.25 * m.mill_radius; x <= 0.25 * m.mill_radius; x += m.field.cell / 4) {
    const double y = surface(m, x);
    if (std::isnan(y)) continue;
    sx += x, sy += y, sxx += x * x, sxy += x * y, n += 1;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return {degrees(std::atan(slope)), (sy - slope * sx) / n};
}

void compare_surface(const ChargeMotion& m, const io::CsvTable& ends, const io::CsvTable& profiles, double speed_rpm) {
  const Line line = middle_of_surface(m);
  const std::vector<double> speeds = ends.numbers("speed_rpm");
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    if (speeds[k] != speed_rpm) continue;
    fmt::print("{:>20} {:>10} {:>10} {:>10}\n", "degrees", "measured", "simulated", "apart");
    const auto row = [&](const char* name, double measured, double simulated) {
      fmt::print("{:>20} {:10.1f} {:10.1f} {:+10.1f}\n", name, measured, simulated, wrap_180(simulated - measured));
    };
    row("toe", ends.numbers("toe_deg")[k], end_of_bed(m, 280, -0.1));
    row("shoulder", ends.numbers("shoulder_deg")[k], end_of_bed(m, 280, 0.1));
    row("slope in the middle", ends.numbers("central_slope_deg")[k], line.slope_deg);
  }
  const std::vector<double> at_speed = profiles.numbers("speed_rpm"), x = profiles.numbers("x_over_R"),
                            y = profiles.numbers("y_over_R");
  double squares = 0, sum = 0, n = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double found = surface(m, x[k] * m.mill_radius) / m.mill_radius;
    if (at_speed[k] != speed_rpm || std::isnan(found)) continue;
    squares += (found - y[k]) * (found - y[k]);
    sum += found - y[k];
    n += 1;
  }
  fmt::print("surface y(x): RMS {:.3f} R, mean {:+.3f} R over {:g} points\n", std::sqrt(squares / n), sum / n, n);
}

void compare_depth(const ChargeMotion& m, const io::CsvTable& table) {
  const Line line = middle_of_surface(m);
  // Axes of the measurement: along the surface, and from the axis towards the air; at their x = 0.
  const double c = std::cos(radians(line.slope_deg)), s = std::sin(radians(line.slope_deg));
  fmt::print("slope of the surface {:.1f} degrees (measured 27), {:.4f} m below the axis (measured 0.03)\n",
             line.slope_deg, -line.height * c);
  const std::vector<std::string> profile = table.texts("profile");
  const std::vector<double> position = table.numbers("position"), value = table.numbers("value");
  fmt::print("{:>10} {:>14} {:>14}\n", "y, m", "measured, m/s", "simulated, m/s");
  double squares = 0, n = 0;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    if (profile[k] != "depth") continue;
    const double d = position[k], x = -d * s, y = d * c;
    const double up = at(m.field, m.field.vx, x, y) * c + at(m.field, m.field.vy, x, y) * s;
    fmt::print("{:10.4f} {:14.3f} {:14.3f}\n", d, value[k], up);
    if (std::isnan(up)) continue;
    squares += (up - value[k]) * (up - value[k]);
    n += 1;
  }
  fmt::print("RMS {:.3f} m/s over {:g} points\n", std::sqrt(squares / n), n);
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Simulated drums beside measured ones"};
  app.require_subcommand(1);
  std::filesystem::path motion, first, second;
  double speed = 0;
  CLI::App* flat = app.add_subcommand("surface", "The free surface");
  flat->add_option("motion", motion, "MOTION.h5")->required();
  flat->add_option("ends", first, "CSV: speed_rpm,toe_deg,shoulder_deg,central_slope_deg")->required();
  flat->add_option("profiles", second, "CSV: speed_rpm,x_over_R,y_over_R")->required();
  flat->add_option("speed", speed, "Rows of this speed, rev/min")->required();
  CLI::App* depth = app.add_subcommand("depth", "Velocity against depth");
  depth->add_option("motion", motion, "MOTION.h5")->required();
  depth->add_option("velocities", first, "CSV: profile,position,value")->required();
  CLI11_PARSE(app, argc, argv);
  const ChargeMotion m = io::read_motion(motion);
  if (flat->parsed()) compare_surface(m, io::read_csv(first), io::read_csv(second), speed);
  if (depth->parsed()) compare_depth(m, io::read_csv(first));
  return 0;
} catch (const Error& e) {
  fmt::print(stderr, "drum_flow: {}\n", e.what());
  return 1;
}
