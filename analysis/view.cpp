#include "analysis/view.h"

#include <algorithm>
#include <cmath>

#include "analysis/film_reader.h"
#include "analysis/mill_camera.h"
#include "analysis/mill_scale.h"
#include "core/mill_shape.h"

namespace tumble::analysis {
namespace {

constexpr double kSnap = 0.006;  // of R: an edge this near to where the balls stop is the shell

}  // namespace

cv::Point2d true_centre(const Detection& ball, const MillView& view) {
  const double r = view.radii[static_cast<std::size_t>(ball.size_class)];
  return {ball.u + view.shift_u * r, ball.v + view.shift_v * r};
}

cv::Point2d about_axis(const Detection& ball, const MillView& view) {
  const cv::Point2d centre = true_centre(ball, view);
  return {centre.x - view.mill.u, view.mill.v - centre.y};
}

std::vector<double> known_radii(const Config& known) {
  std::vector<double> radii;
  for (const BallClass& c : known.charge.balls)
    if (c.radius > 0) radii.push_back(c.radius);
  std::sort(radii.begin(), radii.end());
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  return radii;
}

Circle enclosing_circle(const std::vector<RingEdge>& rings) {
  Circle circle;
  double weight = 0, strongest = 0;
  for (const RingEdge& r : rings) strongest = std::max(strongest, std::abs(r.strength) * r.coverage);
  for (const RingEdge& r : rings) {
    const double w = std::abs(r.strength) * r.coverage;
    if (w < 0.1 * strongest || r.coverage < 0.55) continue;
    circle.radius = std::max(circle.radius, r.circle.radius);
    const double whole = std::pow(r.coverage, 6);  // an arc pulls its centre aside: whole circles have the say
    circle.u += w * whole * r.circle.u;
    circle.v += w * whole * r.circle.v;
    weight += w * whole;
  }
  if (weight == 0) return {};
  circle.u /= weight;
  circle.v /= weight;
  return circle;
}

MillView find_view(const std::vector<std::vector<Detection>>& balls, const BallLook& look, const DrumOutline& outline,
                   const Config& known, std::vector<std::string>& caveats) {
  MillView view;
  view.mill = outline.centre;
  const double mill_radius = 0.5 * known.mill.diameter;  // [m], may be NaN
  const auto sizes = known_radii(known);
  const bool sizes_known = sizes.size() == look.radii.size();

  // True radii: half the distance at which balls touch; detected rims lie inside or outside of them by a common factor.
  const std::size_t classes = look.radii.size();
  std::vector<Contacts> contacts(classes);
  double swell = 1, scale = 0;
  int most_pairs = 0;
  for (std::size_t c = 0; c < classes; ++c) {
    contacts[c] = find_contacts(balls, static_cast<int>(c));
    if (contacts[c].pairs <= most_pairs) continue;
    most_pairs = contacts[c].pairs;
    swell = 0.5 * contacts[c].distance / look.radii[c];
    if (sizes_known) scale = sizes[c] / (0.5 * contacts[c].distance);
  }
  std::vector<double> radii(classes);
  for (std::size_t c = 0; c < classes; ++c)
    radii[c] = scale > 0               ? sizes[c] / scale
               : contacts[c].pairs > 0 ? 0.5 * contacts[c].distance
                                       : swell * look.radii[c];

  // The shell, from the class of which most balls were seen against it. Where mill and balls are known, their ratio
  // says where to look.
  const double guess = scale > 0 && mill_radius > 0 ? mill_radius / scale : 0;
  ShellTouch best;
  double best_radius = 1;
  for (std::size_t c = 0; c < classes; ++c) {
    const double least = guess > 0 ? 0.98 * guess - radii[c] : 0, most = guess > 0 ? 1.02 * guess - radii[c] : 1e9;
    const ShellTouch touch = find_shell_touch(balls, static_cast<int>(c), radii, outline.centre, least, most);
    if (!touch.found || touch.count <= best.count) continue;
    best = touch;
    best_radius = radii[c];
    const bool ratio_known = sizes_known && mill_radius > 0;
    view.mill.radius = ratio_known ? touch.reach / (1 - sizes[c] / mill_radius) : touch.reach + radii[c];
  }
  if (best.found) {
    view.shift_u = best.shift_u / best_radius;
    view.shift_v = best.shift_v / best_radius;
  } else {
    if (guess > 0) view.mill.radius = guess;
    caveats.push_back("few balls were seen to lie against the shell: its circle is a guess from the picture's edges");
  }
  if (const LightShift light = find_light_shift(balls, radii); light.found) {
    // Unequal balls touch in all directions, balls against the shell in those of the charge alone.
    view.shift_u = light.u;
    view.shift_v = light.v;
  }
  const double touched = view.mill.radius;
  double nearest = (best.found ? kSnap : 0.03) * touched;
  for (const RingEdge& ring : outline.rings) {
    const double miss = std::abs(ring.circle.radius - touched);
    if (ring.coverage < 0.5 || miss >= nearest) continue;
    nearest = miss;
    view.mill.radius = ring.circle.radius;
  }

  if (mill_radius > 0)
    view.metres_per_pixel = mill_radius / view.mill.radius;
  else if (scale > 0)
    view.metres_per_pixel = scale;
  view.radii = radii;
  if (sizes_known && !std::isnan(view.metres_per_pixel))
    for (std::size_t c = 0; c < classes; ++c) view.radii[c] = sizes[c] / view.metres_per_pixel;

  view.tip_radius = view.mill.radius;
  if (known.mill.lifters.profile == LifterProfile::kNone && known.origin.contains("mill.lifters.profile")) return view;
  const MillShape shape = make_mill_shape(known);  // worn as the file has it
  if (shape.tip_radius < shape.radius) {
    view.tip_radius = view.mill.radius * shape.tip_radius / shape.radius;
  } else if (known.mill.lifters.height > 0 && mill_radius > 0) {
    view.tip_radius = view.mill.radius * (1 - known.mill.lifters.height / mill_radius);
  }
  return view;
}

void shrink_to_film(ChargeMotion& m, int enlarged) {
  CameraView& camera = m.camera;
  camera.centre_u_px = in_film(camera.centre_u_px, enlarged);
  camera.centre_v_px = in_film(camera.centre_v_px, enlarged);
  camera.radius_px /= enlarged;
  camera.metres_per_pixel *= enlarged;
  for (double* se : {&camera.centre_u_px_se, &camera.centre_v_px_se, &camera.radius_px_se}) *se /= enlarged;
  camera.metres_per_pixel_se *= enlarged;
  if (camera.lens) camera.lens = for_enlarged_pictures(*camera.lens, 1.0 / enlarged);
  camera.width_px /= enlarged;
  camera.height_px /= enlarged;
  m.tracks.change([&](TrackPoint& p) {
    p.u_px = in_film(p.u_px, enlarged);
    p.v_px = in_film(p.v_px, enlarged);
  });
}

void forget_lengths(ChargeMotion& m) {
  for (ProfileRow& row : m.profile) row.head = kNotGiven;
  m.tracks.change([](TrackPoint& p) { p.x = p.y = p.vx = p.vy = p.radius = p.x_se = kNotGiven; });
  m.head = m.centre_of_circulation_x = m.centre_of_circulation_y = {};
  m.mill_radius = m.tip_radius = kNotGiven;
  m.field = {};
  m.surface.clear();
  m.caveats.push_back("scale unknown: give mill.diameter or charge.balls");
}

}  // namespace tumble::analysis
