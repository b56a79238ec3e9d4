#include "analysis/film_pictures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "analysis/charge_motion.h"
#include "analysis/film_reader.h"
#include "analysis/mill_camera.h"
#include "analysis/stills.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

bool knows_mill(const CameraView& camera) {
  return camera.radius_px > 0 && std::isfinite(camera.centre_u_px + camera.centre_v_px);
}

// Where no lens is known, the camera looks along the axis from so far away that there is no perspective.
MillCamera camera_of(const CameraView& view) {
  if (view.lens) return *view.lens;
  constexpr double kAfar = 1e4;  // mill radii
  MillCamera camera;
  camera.focal = view.radius_px * kAfar;
  camera.centre_u = view.centre_u_px;
  camera.centre_v = view.centre_v_px;
  camera.translation = {0, 0, kAfar};
  return camera;
}

// Of the square's pictures: pixels to mill radii or, as the film has it, to the film's pixels, from the middle.
double half_edge(const PictureView& view) { return view.margin * (view.straightened ? 1 : view.camera.radius_px); }

// For every pixel of a picture of `edge` pixels along each side, where it lies in the film's.
struct Map {
  cv::Mat u, v;
};

Map map_of(const PictureView& view, cv::Size film, int enlarged, int edge) {
  Map map{cv::Mat(edge, edge, CV_32F), cv::Mat(edge, edge, CV_32F)};
  const bool known = knows_mill(view.camera);
  const MillCamera camera = known ? camera_of(view.camera) : MillCamera();
  for (int j = 0; j < edge; ++j)
    for (int i = 0; i < edge; ++i) {
      double right = (i + 0.5) / edge * 2 - 1;
      const double down = (j + 0.5) / edge * 2 - 1;
      if (view.mirror && view.clockwise) right = -right;
      cv::Point2d at;
      if (!known) {
        const double half = 0.5 * std::max(film.width, film.height);
        at = {0.5 * film.width - 0.5 + half * right, 0.5 * film.height - 0.5 + half * down};
      } else {
        const double half = half_edge(view);
        at = view.straightened
                 ? picture_of(camera, {half * right, -half * down, -view.depth})
                 : cv::Point2d(view.camera.centre_u_px + half * right, view.camera.centre_v_px + half * down);
        at = {(at.x + 0.5) * enlarged - 0.5, (at.y + 0.5) * enlarged - 0.5};
      }
      map.u.at<float>(j, i) = static_cast<float>(at.x);
      map.v.at<float>(j, i) = static_cast<float>(at.y);
    }
  return map;
}

// Cuts the square out of a film's pictures, transparent black where it reaches beyond them.
class Cutter {
 public:
  Cutter(const PictureView& view, cv::Size film, int enlarged) : edge_(view.edge_px) {
    const double half = knows_mill(view.camera) ? view.margin * view.camera.radius_px * enlarged
                                                : 0.5 * std::max(film.width, film.height);
    // First at the film's own resolution, then made small: else what is fine would flicker.
    const int fine = static_cast<int>(std::lround(std::min(2 * half, 8192.0)));
    map_ = map_of(view, film, enlarged, std::max(fine, edge_));
  }

  Image cut(const cv::Mat& picture) const {
    cv::Mat opaque, square, small;
    cv::cvtColor(picture, opaque, cv::COLOR_BGR2RGBA);
    cv::remap(opaque, square, map_.u, map_.v, cv::INTER_CUBIC, cv::BORDER_CONSTANT);
    cv::resize(square, small, {edge_, edge_}, 0, 0, cv::INTER_AREA);
    Image image(edge_, edge_);
    for (int row = 0; row < edge_; ++row)
      std::memcpy(image.row(row), small.ptr(row), static_cast<std::size_t>(edge_) * 4);
    return image;
  }

 private:
  int edge_;
  Map map_;
};

}  // namespace

void show_film(const std::string& path, const PictureView& view, std::span<const int> frames,
               const std::function<void(const Image&)>& use, const Progress& progress) {
  std::unique_ptr<FilmReader> film;
  std::vector<std::string> stills;
  if (are_stills(path))
    stills = still_files(path);
  else
    film = std::make_unique<FilmReader>(path);
  std::unique_ptr<Cutter> cutter;
  cv::Mat picture;
  int at = -1;
  Image image;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    report(progress, static_cast<double>(i) / static_cast<double>(frames.size()));
    const bool moved = at < frames[i];
    for (; film && at < frames[i]; ++at)
      if (!film->next(picture)) return;
    if (!film && moved) {
      at = frames[i];
      if (at >= static_cast<int>(stills.size())) return;
      picture = read_still(stills[static_cast<std::size_t>(at)]);
    }
    if (!cutter) cutter = std::make_unique<Cutter>(view, picture.size(), film ? film->enlarged() : 1);
    if (moved) image = cutter->cut(picture);
    use(image);
  }
}

Eigen::Vector2d place_in_picture(const PictureView& view, double x, double y, double behind) {
  const double right = view.clockwise ? -x : x;
  Eigen::Vector2d at;  // from the middle, in half edges, v down
  if (view.straightened) {
    at = Eigen::Vector2d(right, -y) / half_edge(view);
  } else {
    const cv::Point2d seen = picture_of(camera_of(view.camera), {right, y, -behind});
    at = Eigen::Vector2d(seen.x - view.camera.centre_u_px, seen.y - view.camera.centre_v_px) / half_edge(view);
  }
  if (view.mirror && view.clockwise) at.x() = -at.x();
  return 0.5 * view.edge_px * (at + Eigen::Vector2d(1, 1)) - Eigen::Vector2d(0.5, 0.5);
}

std::vector<Eigen::Vector2d> ball_in_picture(const PictureView& view, double x, double y, double radius, int corners) {
  Eigen::Vector3d middle(x, y, -radius), right = Eigen::Vector3d::UnitX(), up = Eigen::Vector3d::UnitY();
  double reach = radius;
  if (!view.straightened) {
    // Where lines of sight graze the ball: a circle about the line to its centre, nearer than the centre.
    const MillCamera camera = camera_of(view.camera);
    Eigen::Vector3d eye = -(camera.rotation.transpose() * camera.translation);
    if (view.clockwise) eye.x() = -eye.x();
    const Eigen::Vector3d gaze = middle - eye;
    const double share = radius * radius / gaze.squaredNorm();
    middle -= gaze * share;
    reach *= std::sqrt(1 - share);
    right = gaze.cross(up).normalized();
    up = right.cross(gaze).normalized();
  }
  std::vector<Eigen::Vector2d> outline;
  for (int k = 0; k < corners; ++k) {
    const double a = 2 * kPi * k / corners;
    const Eigen::Vector3d p = middle + reach * (std::cos(a) * right + std::sin(a) * up);
    outline.push_back(place_in_picture(view, p.x(), p.y(), -p.z()));
  }
  return outline;
}

}  // namespace tumble::analysis
