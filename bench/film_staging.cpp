#include "bench/film_staging.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/mill_shape.h"
#include "core/units.h"

namespace tumble::films {

double log_uniform(Random& random, double low, double high) {
  return low * std::exp(random.uniform() * std::log(high / low));
}

void frame_mill(render::FilmLook& look, const FilmMill& mill, Crop crop, Random& random) {
  constexpr std::array<std::array<int, 2>, 7> kSizes = {
      {{1280, 720}, {1280, 720}, {960, 540}, {854, 480}, {640, 360}, {768, 576}, {640, 640}}};
  const auto [width, height] = kSizes[random.below(kSizes.size())];
  const double smallest = *std::min_element(mill.radius.begin(), mill.radius.end());
  const double balls_across = mill.config.mill.diameter / 2 / smallest;
  const double outer = look.flange.there ? look.flange.outer : 1.0;
  const double whole = 0.49 * height / outer;  // so that all of it is seen
  const bool cropped = random.uniform() < (crop == Crop::kNever ? 0 : crop == Crop::kSeldom ? 0.15 : 0.35);
  const double most = cropped ? 2 * whole : whole;
  double radius_px = log_uniform(random, 4, 25) * balls_across;
  radius_px = std::clamp(radius_px, std::min(std::max((cropped ? 1.0 : 0.65) * whole, 4 * balls_across), most), most);
  // A cropped mill keeps its middle in the picture, so that a good part of the charge is seen.
  const double slack_u = cropped ? 0.35 * width : std::max(0.0, width / 2.0 - outer * radius_px);
  const double slack_v = cropped ? 0.35 * height : std::max(0.0, height / 2.0 - outer * radius_px);
  const double wander = crop == Crop::kNever ? 0.4 : 1;
  render::place_mill(look.lens, width, height, radius_px, (width - 1) / 2.0 + wander * slack_u * random.uniform(-1, 1),
                     (height - 1) / 2.0 + wander * slack_v * random.uniform(-1, 1),
                     random.uniform() < 0.3 ? random.uniform() : 0);
}

render::FilmScene scene_of(const FilmMill& mill, bool clockwise) {
  return {make_mill_shape(mill.config), mill.length, clockwise, mill.radius, mill.ball_class};
}

nlohmann::ordered_json json_of(const render::FilmLens& lens, double radius) {
  const render::CameraNumbers n = render::camera_numbers(lens);
  const auto rows = [](const Eigen::Matrix3d& m) {
    std::vector<std::vector<double>> r(3);
    for (int i = 0; i < 3; ++i) r[i] = {m(i, 0), m(i, 1), m(i, 2)};
    return r;
  };
  const Eigen::Vector3d eye = lens.position * radius;
  return {{"width_px", lens.width},
          {"height_px", lens.height},
          {"focal_px", lens.focal},
          {"centre_u_px", lens.centre_u},
          {"centre_v_px", lens.centre_v},
          {"k1", lens.k1},
          {"k2", lens.k2},
          {"camera_from_mill", rows(n.camera_from_mill)},
          {"position_m", {eye.x(), eye.y(), eye.z()}},
          {"yaw_deg", lens.yaw * 180 / kPi},
          {"pitch_deg", lens.pitch * 180 / kPi},
          {"roll_deg", lens.roll * 180 / kPi},
          {"mill_centre_px", {n.mill_centre.x(), n.mill_centre.y()}},
          {"mill_radius_px", n.mill_radius_px}};
}

nlohmann::ordered_json json_of(const FilmMill& mill) {
  const Mill& m = mill.config.mill;
  nlohmann::ordered_json json = {{"radius_m", m.diameter / 2},
                                 {"length_m", mill.length},
                                 {"layers", mill.layers},
                                 {"rpm", rpm_from_rad_s(mill.mill_speed)},
                                 {"speed_fraction", m.speed},
                                 {"filling", mill.config.charge.filling},
                                 {"lifters", m.lifters.count},
                                 {"lifter_profile", name_of(m.lifters.profile)},
                                 {"lifter_height_m", m.lifters.count > 0 ? m.lifters.height : 0.0}};
  for (const BallClass& c : mill.config.charge.balls) json["ball_radii_m"].push_back(c.radius);
  return json;
}

nlohmann::ordered_json json_of(const render::FilmLook& look) {
  constexpr std::array kMarks = {"none", "line", "half", "dots"};
  return {{"exposure_s", look.timing.exposure},
          {"readout_s", look.timing.readout},
          {"flicker", look.timing.flicker},
          {"flicker_hz", look.timing.flicker_hz},
          {"blur_px", look.sensor.blur},
          {"level", look.sensor.level},
          {"noise_shot", look.sensor.shot},
          {"noise_read", look.sensor.read},
          {"gamma", look.sensor.gamma},
          {"lamps", look.lamps.size()},
          {"mark", kMarks[static_cast<std::size_t>(look.balls.mark)]},
          {"marked_share", look.balls.marked_share},
          {"tracers", look.balls.tracers.size()},
          {"hollow_share", look.balls.hollow_share},
          {"flange", look.flange.there},
          {"flange_inner", look.flange.inner},
          {"flange_outer", look.flange.outer},
          {"glares", look.glass.glares},
          {"glare", look.glass.glare},
          {"bars", look.front.bars.size()},
          {"hub", look.front.hub},
          {"overlay", look.overlay.clock || look.overlay.words > 0}};
}

}  // namespace tumble::films
