#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "analysis/charge_mask.h"
#include "analysis/charge_motion.h"
#include "analysis/charge_statistics.h"
#include "analysis/still_edges.h"
#include "analysis/still_view.h"
#include "analysis/stills.h"
#include "analysis/view.h"
#include "core/angle.h"
#include "core/error.h"
#include "core/mill_shape.h"
#include "core/statistics.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr double kBirthScore = 0.4;    // of a ball that is believed
constexpr double kClearLean = 5;       // of the charge to one side [degrees]
constexpr double kCircleError = 1;     // of axis and shell in a still [px]
constexpr double kLeastRadius = 2.5;   // of the largest balls, where these are to be told apart [px]
constexpr double kWhole = 0.98;        // of the mill's area in the picture, for a filling
constexpr double kTallLifters = 1.15;  // shell over tips, at most
constexpr double kSameScale = 0.1;     // by which scales from the balls and from the shell may differ, of the logarithm

std::vector<cv::Mat> read_stills(const std::string& path) {
  std::vector<cv::Mat> stills;
  for (const std::string& file : still_files(path)) {
    cv::Mat still = read_still(file);
    if (!stills.empty() && still.size() != stills[0].size())
      throw InputError(
          file, "has another size than the stills before it; pictures of one mill from one camera were expected");
    stills.push_back(std::move(still));
  }
  return stills;
}

// The shell is the circle at which the charge ends; its edge in the picture has its own centre, since in a view that is
// not quite along the axis the circles of a mill are not concentric.
void place_shell(MillView& view, const DrumOutline& outline, double reach, const Config& known) {
  if (!(reach > 0)) return;
  const double metres = view.mill.radius * view.metres_per_pixel;
  view.mill = {outline.centre.u, outline.centre.v, reach};
  double best = 0;
  const auto put_onto_edges_from = [&](double least, double most) {
    for (const RingEdge& ring : outline.rings) {
      const double at = (ring.circle.radius / reach - least) / (most - least), miss = 2 * at - 1;
      const double weight = ring.coverage * std::abs(ring.strength) * (1 - miss * miss);
      if (std::abs(miss) > 1 || weight <= best) continue;
      best = weight;
      view.mill = ring.circle;
    }
  };
  put_onto_edges_from(0.97, 1.03);
  // No edge there: the charge seems to end at the lifters' tips, and what lies between them is dark.
  if (best == 0) put_onto_edges_from(1.03, kTallLifters);
  view.tip_radius = view.mill.radius;
  if (!(known.mill.diameter > 0)) return;
  view.metres_per_pixel = metres / view.mill.radius;
  const MillShape shape = make_mill_shape(known);  // worn as the file has it
  if (shape.tip_radius < shape.radius)
    view.tip_radius *= shape.tip_radius / shape.radius;
  else if (known.mill.lifters.height > 0)
    view.tip_radius -= known.mill.lifters.height / view.metres_per_pixel;
  const auto sizes = known_radii(known);
  if (sizes.size() == view.radii.size())
    for (std::size_t c = 0; c < sizes.size(); ++c) view.radii[c] = sizes[c] / view.metres_per_pixel;
}

// The drive lifts the charge: its weight pulls against the rotation, so it lies on the side that rises.
Rotation rotation_of(const std::vector<cv::Mat>& shares, const Circle& mill, std::vector<std::string>& caveats) {
  std::vector<double> leans;
  for (const cv::Mat& share : shares) leans.push_back(charge_shape(share, mill).lean_deg);
  const double lean = mean_direction(leans).value;
  if (std::abs(wrap_180(lean)) > kClearLean && std::abs(wrap_180(lean)) < 90) {
    const bool clockwise = wrap_180(lean) < 0;
    caveats.push_back(
        fmt::format("stills do not show the rotation: taken as {}, the charge lying {:.0f} degrees up on "
                    "that side; --rotation overrules",
                    clockwise ? "clockwise" : "counter-clockwise", std::abs(wrap_180(lean))));
    return clockwise ? Rotation::kClockwise : Rotation::kCounterClockwise;
  }
  caveats.push_back("stills do not show the direction of rotation: taken as counter-clockwise; give --rotation");
  return Rotation::kUnknown;
}

// Of balls that cannot be told apart [px]: as known, else a guess that is small beside the mill.
double fine_diameter(const Config& known, const MillView& view) {
  double sum = 0, shares = 0;
  for (const BallClass& c : known.charge.balls)
    if (c.radius > 0) {
      sum += 2 * c.radius * c.share;
      shares += c.share;
    }
  const double diameter = sum / shares / view.metres_per_pixel;
  return std::isnan(diameter) ? 0.08 * view.mill.radius : diameter;
}

}  // namespace

ChargeMotion measure_stills(const std::string& path, const FilmOptions& options, const Progress& progress) {
  cv::setNumThreads(1);
  const std::vector<cv::Mat> stills = read_stills(path);
  const Config none;
  const Config& known = options.mill != nullptr ? *options.mill : none;
  ChargeMotion motion;
  motion.source = MotionSource::kStills;
  motion.frames = static_cast<int>(stills.size());
  motion.rotation = options.rotation;
  DrumOutline outline;
  cv::Mat mean = cv::Mat::zeros(stills[0].size(), CV_32F), grey;
  for (const cv::Mat& still : stills) {
    cv::cvtColor(still, grey, cv::COLOR_BGR2GRAY);
    cv::accumulate(grey, mean);
  }
  mean /= static_cast<double>(stills.size());
  outline.rings = find_concentric_circles(mean, 0.12 * std::min(mean.rows, mean.cols));
  outline.centre = enclosing_circle(outline.rings);
  if (!(outline.centre.radius > 0))
    throw InputError(
        path, "shows no mill; a view along the mill's axis was expected, with most of its round shell in the picture");
  report(progress, 0.1);

  BallEyes eyes;
  std::vector<std::vector<Detection>> balls;
  std::vector<cv::Mat> shares;
  const auto see = [&](ScaleRange scales) {
    const BallLook look = learn_look(eyes.net, stills, outline.centre, known_radii(known), scales);
    balls.clear();
    shares.clear();
    for (const cv::Mat& still : stills) {
      const Detections seen = detect_balls(eyes, still, look, outline.centre, kBirthScore);
      balls.push_back(seen.balls);
      shares.push_back(charge_share(seen, still.size()));
      report(progress, 0.1 + 0.5 * static_cast<double>(balls.size()) / static_cast<double>(stills.size()));
    }
    return look;
  };
  BallLook look = see({});
  // Graded balls look alike one class up or down; the charge ends at the shell at any scale, and that tells the right
  // one.
  const double reach = charge_reach(shares, outline.centre);
  if (!look.radii.empty() && !known_radii(known).empty() && known.mill.diameter > 0 && reach > 0) {
    const double scale = reach / (0.5 * known.mill.diameter);
    if (std::abs(std::log(look.radii.front() / known_radii(known).front() / scale)) > kSameScale)
      look = see({0.97 * scale, 1.06 * scale});  // balls lie inside the shell, not against it all along
  }
  const bool large_enough = !(reach > 0) || known_radii(known).empty() ||
                            !(known_radii(known).back() * reach < kLeastRadius * 0.5 * known.mill.diameter);
  const bool resolved =
      large_enough && std::any_of(balls.begin(), balls.end(), [](const auto& f) { return !f.empty(); });
  MillView view;
  if (resolved) {
    view = find_view(balls, look, outline, known, motion.caveats);
  } else {
    shares = two_tone_shares(stills, outline.centre);
    if (shares.empty())
      throw InputError(path,
                       "shows neither balls of at least 3 pixels' radius nor a bed of one tone before another; one or "
                       "the other was expected in the mill");
    motion.caveats.push_back("balls too small to be told apart: toe, shoulder and filling are those of the bed's tone");
    view.mill = outline.centre;
    view.metres_per_pixel = 0.5 * known.mill.diameter / view.mill.radius;
  }
  place_shell(view, outline, charge_reach(shares, outline.centre), known);
  if (resolved) {
    for (std::size_t i = 0; i < stills.size(); ++i) cover_discs(shares[i], balls[i], view);
    add_charge_colours(shares, stills, view.mill);
  }
  if (motion.rotation == Rotation::kUnknown) motion.rotation = rotation_of(shares, view.mill, motion.caveats);
  const bool clockwise = motion.rotation == Rotation::kClockwise;
  motion.camera.centre_u_px = view.mill.u;
  motion.camera.centre_v_px = view.mill.v;
  motion.camera.radius_px = view.mill.radius;
  motion.camera.metres_per_pixel = view.metres_per_pixel;
  motion.camera.width_px = mean.cols;
  motion.camera.height_px = mean.rows;
  motion.mill_radius = view.mill.radius * view.metres_per_pixel;

  const double unit = std::isnan(view.metres_per_pixel) ? 1.0 : view.metres_per_pixel;
  double diameters = 0, count = 0;
  for (auto& f : balls) {
    std::erase_if(f, [&](const Detection& d) {
      return std::hypot(d.u - view.mill.u, d.v - view.mill.v) + d.radius > 1.02 * view.mill.radius;
    });
    for (const Detection& d : f) {
      diameters += 2 * view.radii[static_cast<std::size_t>(d.size_class)];
      count += 1;
    }
  }
  const double diameter = count > 0 ? diameters / count : fine_diameter(known, view);  // [px]

  motion.lifter_count = known.mill.lifters.count;
  const bool tips_known = known.mill.diameter > 0 && view.tip_radius < view.mill.radius;
  if (!tips_known || motion.lifter_count < 1) {
    const StillLifters seen = find_still_lifters(stills, shares, view.mill, motion.lifter_count);
    motion.lifter_count = seen.count;
    if (!tips_known && seen.count > 0) view.tip_radius = seen.tip_radius;
  }
  motion.tip_radius = view.tip_radius * view.metres_per_pixel;
  const Ring ring = edge_ring(view.tip_radius, diameter);
  const int passages = motion.lifter_count > 0 ? motion.lifter_count : kUsualLifters;
  const int width = 2 * (static_cast<int>(std::lround(360.0 / passages)) / 2) + 1;  // one lifter spacing
  MillGeometry geometry;
  geometry.radius = view.mill.radius * unit;
  geometry.tip_radius = view.tip_radius * unit;
  geometry.mean_diameter = diameter * unit;
  ChargeStatistics statistics(geometry);
  RingProfile sum{};
  std::array<std::vector<double>, 3> toes, shoulders;
  std::vector<double> fillings;
  std::vector<ChargeEdges> edges;
  int id = 0;
  for (std::size_t i = 0; i < stills.size(); ++i) {
    const RingProfile profile = mask_occupancy(shares[i], view.mill, ring, clockwise);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += profile[k] / static_cast<double>(stills.size());
    edges.push_back(find_edges(smooth(profile, width)));
    for (std::size_t l = 0; l < 3; ++l) {
      toes[l].push_back(edges.back().toe[l]);
      shoulders[l].push_back(edges.back().shoulder[l]);
    }
    fillings.push_back(charge_shape(shares[i], view.mill).area /
                       (kSettledAreaShare * kPi * view.mill.radius * view.mill.radius));
    std::vector<TrackPoint> points;
    for (const Detection& d : balls[i]) {
      TrackPoint p;
      p.frame = static_cast<int>(i);
      p.id = id++;
      p.time = kNotGiven;
      const cv::Point2d place = about_axis(d, view), centre = true_centre(d, view);
      p.x = (clockwise ? -1 : 1) * place.x * unit;
      p.y = place.y * unit;
      p.radius = view.radii[static_cast<std::size_t>(d.size_class)] * unit;
      p.u_px = centre.x;
      p.v_px = centre.y;
      points.push_back(p);
    }
    statistics.add(static_cast<int>(i), kNotGiven, kNotGiven, points);
  }
  statistics.finish(motion);
  // Edges from the pixels that show charge: not every ball of a still is found, but all of them have its colours.
  const EdgeEstimates whole = edges_of_still(sum, width, degrees(diameter / view.tip_radius));
  const double by_circle = degrees(kCircleError / view.mill.radius);
  const auto with_error = [&](Estimate edge, const std::vector<double>& single) {
    edge.se = std::hypot(std::fmax(edge.se, mean_direction(single).se), by_circle);
    return edge;
  };
  Estimate* toe[] = {&motion.toe_deg, &motion.toe_bulk_deg, &motion.toe_outer_deg};
  Estimate* shoulder[] = {&motion.shoulder_deg, &motion.shoulder_bulk_deg, &motion.shoulder_outer_deg};
  for (std::size_t l = 0; l < 3; ++l) {
    *toe[l] = with_error(whole.toe[l], toes[l]);
    *shoulder[l] = with_error(whole.shoulder[l], shoulders[l]);
  }
  motion.ring_occupancy = sum;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    motion.profile[i].toe_deg = edges[i].toe[kHalf];
    motion.profile[i].shoulder_deg = edges[i].shoulder[kHalf];
  }
  const double in_picture = charge_shape(cv::Mat::ones(shares[0].size(), CV_32F), view.mill).area /
                            (kPi * view.mill.radius * view.mill.radius);
  if (in_picture > kWhole)
    motion.filling = mean_of_series(fillings);
  else
    motion.caveats.push_back(fmt::format("only {:.0f} % of the mill lie in the picture: no filling", 100 * in_picture));
  if (std::isnan(view.metres_per_pixel)) forget_lengths(motion);
  report(progress, 1.0);
  return motion;
}

}  // namespace tumble::analysis
