// Oblique rebound of a sphere from a flat plate: the contact law against measurements (Kharaz, Gorham & Salman, Powder
// Technol. 120 (2001) 281). Nothing is fitted: friction is the measured 0.092, restitution 1 as their source takes it;
// k_t / k_n is Mindlin's 2 (1 - nu) / (2 - nu) for equal moduli, the 1992 paper's 2/3, and its Table 3's 3/4.
//   oblique_impact MEASURED.csv [-o PAGE.html]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>

#include "core/angle.h"
#include "core/error.h"
#include "core/version.h"
#include "io/csv_file.h"
#include "io/plot_page.h"
#include "tests/support/balls.h"

using namespace tumble;
using namespace tumble::sim;

namespace {

constexpr double kRadius = 0.0025, kSpeed = 3.9, kFriction = 0.092;  // [m], [m/s]
constexpr double kPoisson = 0.24;                                    // of sphere (0.23) and plate (0.25)

struct Rebound {
  double tangential_restitution, spin, rebound_angle_deg;
};

// One impact of the simulated sphere, `angle_deg` from the normal.
Rebound rebound(double angle_deg, double stiffness_ratio) {
  const double mass = 4000 * 4.0 / 3 * kPi * kRadius * kRadius * kRadius, k_n = 1e7;  // the law has no scale of its own
  const LinearSpringDashpot law{k_n, stiffness_ratio * k_n, kFriction, 1};
  const double dt = contact_time(law, mass) / 500;
  const double normal = kSpeed * std::cos(radians(angle_deg)), along = kSpeed * std::sin(radians(angle_deg));
  // The plate is the inside of a shell so large that it is flat: 10 km.
  const double plate = 1e4;
  RunningMill mill = start_mill(
      smooth_shell(plate, 0, law, dt),
      charge_of(
          {{.radius = kRadius, .mass = mass, .x = plate - kRadius - 10 * kSpeed * dt, .vx = normal, .vy = along}}));
  for (int k = 0; k < 5000; ++k) advance(mill);
  const double out = -vx_of(mill, 0), slid = vy_of(mill, 0);
  return {std::abs(slid / along), std::abs(mill.charge.spin[0]), degrees(std::atan2(slid, out))};
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"The contact law against measured oblique rebounds"};
  std::filesystem::path measured, page_file;
  app.add_option("measured", measured, "CSV: quantity,impact_angle_deg,value")->required();
  app.add_option("-o,--output", page_file, "Page of plots");
  CLI11_PARSE(app, argc, argv);

  const io::CsvTable table = io::read_csv(measured);
  const std::vector<std::string> quantity = table.texts("quantity");
  const std::vector<double> angle = table.numbers("impact_angle_deg"), value = table.numbers("value");
  const std::map<std::string, double Rebound::*> quantities{
      {"tangential_restitution", &Rebound::tangential_restitution},
      {"spin_rad_per_s", &Rebound::spin},
      {"rebound_angle_deg", &Rebound::rebound_angle_deg}};
  const std::vector<std::pair<std::string, double>> ratios{
      {"Mindlin", 2 * (1 - kPoisson) / (2 - kPoisson)}, {"2/3", 2.0 / 3}, {"3/4", 0.75}};

  io::PlotPage page{.kind = "Validation", .title = "Oblique rebound of a sphere", .version = kVersion};
  page.lead = "Kharaz, Gorham & Salman (2001), 3.9 m/s; nothing fitted.";
  for (const auto& [name, member] : quantities) {
    io::Plot plot{.title = name, .x_label = "impact angle from the normal, degrees", .y_label = name};
    io::PlotSeries points{.label = "measured", .mark = io::PlotMark::kPoints, .colour = 0};
    for (std::size_t k = 0; k < table.rows(); ++k) {
      if (quantity[k] != name) continue;
      points.x.push_back(angle[k]);
      points.y.push_back(value[k]);
    }
    plot.series.push_back(points);
    fmt::print("{}\n{:>10} {:>10}", name, "angle_deg", "measured");
    for (const auto& [label, ratio] : ratios) fmt::print(" {:>16}", fmt::format("k_t/k_n {:.3f}", ratio));
    fmt::print("\n");
    std::vector<double> squares(ratios.size());
    for (std::size_t k = 0; k < points.x.size(); ++k) {
      fmt::print("{:10.2f} {:10.4g}", points.x[k], points.y[k]);
      for (std::size_t r = 0; r < ratios.size(); ++r) {
        const double found = rebound(points.x[k], ratios[r].second).*member;
        fmt::print(" {:16.4g}", found);
        squares[r] += (found - points.y[k]) * (found - points.y[k]);
      }
      fmt::print("\n");
    }
    fmt::print("{:>21}", "RMS residual");
    for (const double s : squares) fmt::print(" {:16.3g}", std::sqrt(s / double(points.x.size())));
    fmt::print("\n\n");
    for (const auto& [label, ratio] : ratios) {
      io::PlotSeries line{.label = fmt::format("k_t/k_n = {:.3f} ({})", ratio, label)};
      for (double a = 0.5; a < 65; a += 0.5) {
        line.x.push_back(a);
        line.y.push_back(rebound(a, ratio).*member);
      }
      plot.series.push_back(line);
    }
    page.sections.push_back({.heading = name, .plots = {plot}});
  }
  if (!page_file.empty()) io::write_plot_page(page_file, page);
  return 0;
} catch (const Error& e) {
  fmt::print(stderr, "oblique_impact: {}\n", e.what());
  return 1;
}
