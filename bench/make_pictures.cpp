#include <fmt/format.h>

#include <array>
#include <chrono>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "bench/film_commands.h"
#include "bench/film_staging.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "io/film_file.h"

namespace fs = std::filesystem;

namespace tumble::films {
namespace {

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

// The second frame of a film of two, as H.264 leaves it: noise wiped out, what moves smeared over what was there.
cv::Mat as_filmed(const fs::path& stem, const Image& before, const Image& image, double crf) {
  const std::string scratch = stem.string() + ".scratch.mp4";
  io::FilmFormat format;
  format.width = image.width;
  format.height = image.height;
  format.crf = crf;
  format.threads = 1;
  io::FilmWriter film(scratch, format);
  film.write(before);
  film.write(image);
  film.finish();
  cv::Mat picture;
  cv::VideoCapture reader(scratch);
  for (int k = 0; k < 2; ++k)
    if (!reader.read(picture)) throw WorkError(scratch, "could not be read back");
  fs::remove(scratch);
  return picture;
}

// Compression as it happens to films: some pictures twice, on another grid of blocks.
void write_picture(const fs::path& stem, cv::Mat picture, int level, Random& random) {
  const auto quality = [&](double low, double high) { return static_cast<int>(random.uniform(low, high)); };
  if (level > 0 && random.uniform() < 0.2) {
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

void write_truth(const fs::path& stem, const render::FilmPicture& picture, const render::FilmScene& scene) {
  std::ofstream csv(stem.string() + ".csv");
  csv << "id,u_px,v_px,r_px,visible,x_m,y_m,z_m,theta_rad,class,marked,glare\n";
  for (const render::SeenBall& b : picture.balls) {
    const double r = b.radius_px;
    if (b.u < -r || b.v < -r || b.u > picture.image.width + r || b.v > picture.image.height + r) continue;
    csv << fmt::format("{},{:.3f},{:.3f},{:.3f},{:.3f},{:.6f},{:.6f},{:.6f},{:.4f},{},{},{:.3f}\n", b.ball, b.u, b.v, r,
                       b.visible, b.state.x, b.state.y, b.state.z, b.state.angle, scene.ball_class[b.ball],
                       int(b.marked), b.glare);
  }
  if (!csv.flush()) throw WorkError(stem.string() + ".csv", "could not be written");
  const cv::Mat mask(picture.image.height, picture.image.width, CV_8UC1,
                     const_cast<std::uint8_t*>(picture.coverage.data()));
  if (!cv::imwrite(stem.string() + "_mask.png", mask, {cv::IMWRITE_PNG_COMPRESSION, 2}))
    throw WorkError(stem.string() + "_mask.png", "could not be written");
}

}  // namespace

void make_pictures(const PictureOrder& order) {
  limit_threads(1);
  fs::create_directories(order.folder);
  const std::uint64_t mill_seed = order.mill_seed.value_or(order.seed);
  const auto mills =
      cached_mills(order.folder / fmt::format("mills_{}_{}.bin", mill_seed, order.mills), mill_seed, order.mills);
  render::FilmCamera camera;
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < order.count; ++k) {
    const std::uint64_t seed = order.seed * 1000003 + static_cast<std::uint64_t>(k);
    Random random(seed);
    random.next();
    const FilmMill& mill = mills[random.below(mills.size())];
    const FilmMill::State& state = mill.states[random.below(mill.states.size())];
    constexpr std::array kLevels = {0, 1, 1, 2, 2, 2, 3, 3};
    const int level = order.level >= 0 ? order.level : kLevels[random.below(kLevels.size())];
    render::FilmLook look = render::random_look(seed, level);
    frame_mill(look, mill, level == 0 ? Crop::kNever : level == 1 ? Crop::kSeldom : Crop::kOften, random);
    render::FilmScene scene = scene_of(mill, random.uniform() < 0.5);
    const PlacedBalls placed = place_balls(mill, state, random);
    scene.radius.clear();
    scene.ball_class.clear();
    for (const std::size_t i : placed.ball) {
      scene.radius.push_back(mill.radius[i]);
      scene.ball_class.push_back(mill.ball_class[i]);
    }
    render::FilmMoment moment;
    moment.time = random.uniform(0, 600);
    moment.mill_angle = state.mill_angle;
    moment.mill_speed = mill.mill_speed;
    moment.ball = [&](std::size_t i, double later) {
      render::BallState b = state.balls[placed.ball[i]];
      b.x += b.vx * later;
      b.y += b.vy * later;
      b.angle += b.spin * later;
      b.z = placed.z[i];
      return b;
    };
    camera.aim(look, scene);
    const fs::path stem = order.folder / fmt::format("p{}_{:06}", order.seed, k);
    const render::FilmPicture picture = camera.draw(moment, 1);
    if (level > 0 && random.uniform() < 0.2) {
      const double frame_time = 1 / log_uniform(random, 25, 240);
      render::FilmMoment earlier = moment;
      earlier.mill_angle -= mill.mill_speed * frame_time;
      earlier.ball = [&](std::size_t i, double later) { return moment.ball(i, later - frame_time); };
      const Image before = camera.draw(earlier, 0).image;
      write_picture(stem, as_filmed(stem, before, picture.image, random.uniform(18, 34)), 0, random);
    } else {
      write_picture(stem, opencv_picture(picture.image), level, random);
    }
    write_truth(stem, picture, scene);
    const nlohmann::ordered_json json = {{"seed", seed},
                                         {"level", level},
                                         {"clockwise", scene.clockwise},
                                         {"mill", json_of(mill)},
                                         {"camera", json_of(look.lens, scene.shape.radius)},
                                         {"look", json_of(look)}};
    std::ofstream(stem.string() + ".json") << json.dump(1) << '\n';
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fmt::print("{} pictures in {:.1f} s: {:.2f} a second\n", order.count, seconds, order.count / seconds);
}

}  // namespace tumble::films
