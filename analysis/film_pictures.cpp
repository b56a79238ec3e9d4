#include "analysis/film_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "analysis/film_reader.h"

namespace tumble::analysis {
namespace {

Image seen(const cv::Mat& picture, const PictureView& view, int enlarged) {
  double u = 0.5 * picture.cols, v = 0.5 * picture.rows, half = 0.5 * std::max(picture.cols, picture.rows);
  if (view.camera.radius_px > 0 && std::isfinite(view.camera.centre_u_px + view.camera.centre_v_px)) {
    u = (view.camera.centre_u_px + 0.5) * enlarged;
    v = (view.camera.centre_v_px + 0.5) * enlarged;
    half = view.margin * view.camera.radius_px * enlarged;
  }
  // What the square holds of the picture, on black where it reaches beyond.
  const int edge = std::max(2, static_cast<int>(std::lround(2 * half)));
  const cv::Rect square(static_cast<int>(std::lround(u - half)), static_cast<int>(std::lround(v - half)), edge, edge);
  const cv::Rect inside = square & cv::Rect(0, 0, picture.cols, picture.rows);
  cv::Mat cut = cv::Mat::zeros(edge, edge, picture.type());
  if (!inside.empty()) picture(inside).copyTo(cut(inside - square.tl()));
  cv::Mat small;
  cv::resize(cut, small, {view.edge_px, view.edge_px}, 0, 0, edge > view.edge_px ? cv::INTER_AREA : cv::INTER_LINEAR);
  if (view.mirror) cv::flip(small, small, 1);
  cv::cvtColor(small, small, cv::COLOR_BGR2RGBA);
  Image image(small.cols, small.rows);
  for (int row = 0; row < small.rows; ++row)
    std::memcpy(image.row(row), small.ptr(row), static_cast<std::size_t>(small.cols) * 4);
  return image;
}

}  // namespace

void show_film(const std::string& path, const PictureView& view, std::span<const int> frames,
               const std::function<void(const Image&)>& use, const Progress& progress) {
  FilmReader film(path);
  cv::Mat picture;
  int at = -1;
  Image image;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    report(progress, static_cast<double>(i) / static_cast<double>(frames.size()));
    bool moved = false;
    for (; at < frames[i]; ++at, moved = true)
      if (!film.next(picture)) return;
    if (moved || i == 0) image = seen(picture, view, film.enlarged());
    use(image);
  }
}

}  // namespace tumble::analysis
