#include "analysis/view.h"

#include <algorithm>
#include <cmath>

#include "analysis/mill_scale.h"

namespace tumble::analysis {
namespace {

constexpr double kSnap = 0.006;  // of R: an edge this near to where the balls stop is the shell

}  // namespace

std::vector<double> known_radii(const Config& known) {
  std::vector<double> radii;
  for (const BallClass& c : known.charge.balls)
    if (c.radius > 0) radii.push_back(c.radius);
  std::sort(radii.begin(), radii.end());
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  return radii;
}

MillView find_view(const std::vector<std::vector<Detection>>& balls, const BallLook& look, const FilmSurvey& survey,
                   const DrumPattern& drum, const Config& known, std::vector<std::string>& caveats) {
  MillView view;
  view.mill = survey.centre;
  const double mill_radius = 0.5 * known.mill.diameter;  // [m], may be NaN
  const auto sizes = known_radii(known);
  const bool sizes_known = sizes.size() == look.radii.size();

  double weight = 0, radius = 0, shift_u = 0, shift_v = 0, scale = 0, scale_weight = 0;
  std::vector<double> contact(look.radii.size(), 0.0);
  for (std::size_t c = 0; c < look.radii.size(); ++c) {
    const int k = static_cast<int>(c);
    contact[c] = 0.5 * contact_distance(balls, k);
    if (sizes_known && contact[c] > 0) {
      scale += sizes[c] / contact[c];
      scale_weight += 1;
    }
    const ShellTouch touch = find_shell_touch(balls, k, survey.centre);
    if (!touch.found) continue;
    double r = touch.reach + contact[c];
    if (sizes_known && mill_radius > 0) r = touch.reach / (1 - sizes[c] / mill_radius);
    if (contact[c] == 0 && !(sizes_known && mill_radius > 0)) r = touch.reach + look.radii[c];
    const double w = touch.count;
    radius += w * r;
    shift_u += w * touch.shift_u;
    shift_v += w * touch.shift_v;
    weight += w;
  }
  if (weight > 0) {
    view.mill.radius = radius / weight;
    view.shift_u = shift_u / weight;
    view.shift_v = shift_v / weight;
  } else {
    caveats.push_back("no balls were seen to lie against the shell: its circle is a guess from the picture's edges");
  }
  double nearest = kSnap * view.mill.radius;
  const double touched = view.mill.radius;
  for (const RingEdge& ring : survey.rings) {
    const double miss = std::abs(ring.circle.radius - touched);
    if (ring.coverage < 0.5 || miss >= nearest) continue;
    nearest = miss;
    view.mill.radius = ring.circle.radius;
  }

  if (mill_radius > 0)
    view.metres_per_pixel = mill_radius / view.mill.radius;
  else if (scale_weight > 0)
    view.metres_per_pixel = scale / scale_weight;

  for (std::size_t c = 0; c < look.radii.size(); ++c) {
    double r = contact[c] > 0 ? contact[c] : look.radii[c];
    if (sizes_known && !std::isnan(view.metres_per_pixel)) r = sizes[c] / view.metres_per_pixel;
    view.radii.push_back(r);
  }

  view.tip_radius = view.mill.radius;
  if (known.mill.lifters.profile == LifterProfile::kNone && known.mill.lifters.count > 0) return view;
  if (known.mill.lifters.height > 0 && mill_radius > 0) {
    view.tip_radius = view.mill.radius * (1 - known.mill.lifters.height / mill_radius);
  } else if (drum.lifter_count > 0) {
    double strongest =
        0;  // lifters wash out in the mean picture: their tips leave the clearest circle inside the shell
    for (const RingEdge& ring : survey.rings) {
      const double share = ring.circle.radius / view.mill.radius, s = std::abs(ring.strength) * ring.coverage;
      if (share < 0.8 || share > 0.985 || ring.coverage < 0.55 || s <= strongest) continue;
      strongest = s;
      view.tip_radius = ring.circle.radius;
    }
  }
  return view;
}

void forget_lengths(ChargeMotion& m) {
  for (ProfileRow& row : m.profile) row.head = kNotGiven;
  for (TrackPoint& p : m.tracks) p.x = p.y = p.vx = p.vy = p.radius = kNotGiven;
  m.head = m.centre_of_circulation_x = m.centre_of_circulation_y = {};
  m.mill_radius = m.tip_radius = kNotGiven;
  m.field = {};
}

}  // namespace tumble::analysis
