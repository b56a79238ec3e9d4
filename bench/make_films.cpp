// Films and pictures of mills as a camera in a laboratory takes them, with the exact truth: to train and to try the
// analyser of films.
//   make_films pictures --count N --seed S --out DIR
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "bench/film_mills.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "core/units.h"
#include "render/film_camera.h"

using namespace tumble;
namespace fs = std::filesystem;

namespace {

struct Options {
  fs::path out;
  std::uint64_t seed = 1;
  int count = 10, mills = 40, level = -1;
  std::optional<std::uint64_t> mill_seed;
};

double log_uniform(Random& random, double low, double high) {
  return low * std::exp(random.uniform() * std::log(high / low));
}

// A picture's size and where the mill stands in it, so that the smallest balls have a fair size.
void frame_mill(render::FilmLook& look, const films::FilmMill& mill, int level, Random& random) {
  constexpr std::array<std::array<int, 2>, 7> kSizes = {
      {{1280, 720}, {1280, 720}, {960, 540}, {854, 480}, {640, 360}, {768, 576}, {640, 640}}};
  const auto [width, height] = kSizes[random.below(kSizes.size())];
  const double smallest = *std::min_element(mill.radius.begin(), mill.radius.end());
  const double balls_across = mill.config.mill.diameter / 2 / smallest;
  const double outer = look.flange.there ? look.flange.outer : 1.0;
  const double whole = 0.48 * height / outer;  // so that all of it is seen
  const bool may_crop = level > 0 && random.uniform() < (level == 1 ? 0.15 : 0.35);
  const double most = may_crop ? 2.2 * whole : whole;
  double radius_px = log_uniform(random, 4, 25) * balls_across;
  radius_px = std::clamp(radius_px, std::min(std::max(0.5 * whole, 4 * balls_across), most), most);
  const double slack_u = may_crop ? 0.45 * width : std::max(0.0, width / 2.0 - outer * radius_px);
  const double slack_v = may_crop ? 0.45 * height : std::max(0.0, height / 2.0 - outer * radius_px);
  const double wander = level == 0 ? 0.2 : 1;
  render::place_mill(look.lens, width, height, radius_px, (width - 1) / 2.0 + wander * slack_u * random.uniform(-1, 1),
                     (height - 1) / 2.0 + wander * slack_v * random.uniform(-1, 1),
                     random.uniform() < 0.3 ? random.uniform() : 0);
}

cv::Mat opencv_picture(const Image& image) {
  cv::Mat bgr;
  cv::cvtColor(cv::Mat(image.height, image.width, CV_8UC4, const_cast<std::uint8_t*>(image.rgba.data())), bgr,
               cv::COLOR_RGBA2BGR);
  return bgr;
}

cv::Mat once_compressed(const cv::Mat& picture, int quality) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

// Compression as it happens to films: some pictures twice, on another grid of blocks.
void write_picture(const fs::path& stem, const Image& image, int level, Random& random) {
  cv::Mat picture = opencv_picture(image);
  const auto quality = [&](double low, double high) { return static_cast<int>(random.uniform(low, high)); };
  if (level > 0 && random.uniform() < 0.3) {
    const int shift = 1 + static_cast<int>(random.below(7));
    cv::Mat wide;
    cv::copyMakeBorder(picture, wide, shift, 0, shift, 0, cv::BORDER_REPLICATE);
    wide = once_compressed(wide, quality(35, 90));
    picture = wide(cv::Rect(shift, shift, picture.cols, picture.rows)).clone();
  }
  const bool written = random.uniform() < 0.1
                           ? cv::imwrite(stem.string() + ".png", picture, {cv::IMWRITE_PNG_COMPRESSION, 1})
                           : cv::imwrite(stem.string() + ".jpg", picture, {cv::IMWRITE_JPEG_QUALITY, quality(40, 96)});
  if (!written) throw WorkError(stem.string(), "could not be written");
}

nlohmann::ordered_json camera_json(const render::FilmLens& lens, double radius) {
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

void write_truth(const fs::path& stem, const render::FilmPicture& picture, const films::FilmMill& mill) {
  std::ofstream csv(stem.string() + ".csv");
  csv << "id,u_px,v_px,r_px,visible,x_m,y_m,z_m,theta_rad,class,marked\n";
  for (const render::SeenBall& b : picture.balls) {
    const double r = b.radius_px;
    if (b.u < -r || b.v < -r || b.u > picture.image.width + r || b.v > picture.image.height + r) continue;
    csv << fmt::format("{},{:.3f},{:.3f},{:.3f},{:.3f},{:.6f},{:.6f},{:.6f},{:.4f},{},{}\n", b.ball, b.u, b.v, r,
                       b.visible, b.state.x, b.state.y, b.state.z, b.state.angle, mill.ball_class[b.ball],
                       int(b.marked));
  }
  if (!csv.flush()) throw WorkError(stem.string() + ".csv", "could not be written");
  const cv::Mat mask(picture.image.height, picture.image.width, CV_8UC1,
                     const_cast<std::uint8_t*>(picture.coverage.data()));
  if (!cv::imwrite(stem.string() + "_mask.png", mask, {cv::IMWRITE_PNG_COMPRESSION, 2}))
    throw WorkError(stem.string() + "_mask.png", "could not be written");
}

void make_pictures(const Options& o) {
  limit_threads(1);
  fs::create_directories(o.out);
  const std::uint64_t mill_seed = o.mill_seed.value_or(o.seed);
  const auto mills =
      films::cached_mills(o.out / fmt::format("mills_{}_{}.bin", mill_seed, o.mills), mill_seed, o.mills);
  render::FilmCamera camera;
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < o.count; ++k) {
    const std::uint64_t seed = o.seed * 1000003 + static_cast<std::uint64_t>(k);
    Random random(seed);
    random.next();
    const films::FilmMill& mill = mills[random.below(mills.size())];
    const films::FilmMill::State& state = mill.states[random.below(mill.states.size())];
    constexpr std::array kLevels = {0, 1, 1, 2, 2, 2, 3, 3};
    const int level = o.level >= 0 ? o.level : kLevels[random.below(kLevels.size())];
    render::FilmLook look = render::random_look(seed, level);
    frame_mill(look, mill, level, random);
    render::FilmScene scene{make_mill_shape(mill.config), mill.length, random.uniform() < 0.5, mill.radius,
                            mill.ball_class};
    const std::vector<double> z = films::depths_of(mill, state, random);
    render::FilmMoment moment;
    moment.time = random.uniform(0, 600);
    moment.mill_angle = state.mill_angle;
    moment.mill_speed = mill.mill_speed;
    moment.ball = [&](std::size_t i, double later) {
      render::BallState b = state.balls[i];
      b.x += b.vx * later;
      b.y += b.vy * later;
      b.angle += b.spin * later;
      b.z = z[i];
      return b;
    };
    camera.aim(look, scene);
    const render::FilmPicture picture = camera.draw(moment, 0);
    const fs::path stem = o.out / fmt::format("p{}_{:06}", o.seed, k);
    write_picture(stem, picture.image, level, random);
    write_truth(stem, picture, mill);
    nlohmann::ordered_json json = {{"seed", seed},
                                   {"level", level},
                                   {"mill_radius_m", scene.shape.radius},
                                   {"length_m", mill.length},
                                   {"layers", mill.layers},
                                   {"clockwise", scene.clockwise},
                                   {"speed_fraction", mill.config.mill.speed},
                                   {"filling", mill.config.charge.filling},
                                   {"lifters", mill.config.mill.lifters.count},
                                   {"exposure_s", look.timing.exposure},
                                   {"readout_s", look.timing.readout},
                                   {"camera", camera_json(look.lens, scene.shape.radius)}};
    for (const BallClass& c : mill.config.charge.balls) json["ball_radii_m"].push_back(c.radius);
    std::ofstream(stem.string() + ".json") << json.dump(1) << '\n';
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fmt::print("{} pictures in {:.1f} s: {:.2f} a second\n", o.count, seconds, o.count / seconds);
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Films and pictures of mills as a camera takes them, with the truth"};
  app.require_subcommand(1);
  Options o;
  CLI::App* pictures = app.add_subcommand("pictures", "Independent pictures, each of another mill, light and camera");
  pictures->add_option("--count", o.count, "How many");
  pictures->add_option("--seed", o.seed, "Of everything");
  pictures->add_option("--out", o.out, "Folder")->required();
  pictures->add_option("--level", o.level, "0 clean to 3 nasty; any if not given");
  pictures->add_option("--mills", o.mills, "Mills to simulate");
  pictures->add_option("--mill-seed", o.mill_seed, "Of the mills, to share them between calls; --seed if not given");
  CLI11_PARSE(app, argc, argv);
  make_pictures(o);
  return 0;
} catch (const Error& e) {
  fmt::print(stderr, "make_films: {}\n", e.what());
  return e.kind() == Error::Kind::kInputWrong ? 2 : 1;
}
