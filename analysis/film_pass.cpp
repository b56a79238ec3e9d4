#include "analysis/film_pass.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "analysis/film_reader.h"
#include "analysis/frame_clock.h"
#include "core/parallel_for.h"

namespace tumble::analysis {
namespace {

// Mean colour of a ball's inner part, where its neighbours do not reach.
std::array<float, 3> colour_of(const cv::Mat& bgr, const Detection& d) {
  const double r = 0.6 * d.radius;
  std::array<double, 3> sum{};
  double count = 0;
  const int v0 = std::max(0, static_cast<int>(std::ceil(d.v - r))),
            u0 = std::max(0, static_cast<int>(std::ceil(d.u - r)));
  for (int v = v0; v <= std::min(bgr.rows - 1, static_cast<int>(d.v + r)); ++v)
    for (int u = u0; u <= std::min(bgr.cols - 1, static_cast<int>(d.u + r)); ++u) {
      if ((u - d.u) * (u - d.u) + (v - d.v) * (v - d.v) > r * r) continue;
      const auto& p = bgr.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += p[c];
      count += 1;
    }
  std::array<float, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c) colour[c] = static_cast<float>(count > 0 ? sum[c] / count : 0.0);
  return colour;
}

}  // namespace

FilmPass look_through(const std::string& path, const DrumView& drum, const BallLook& look, const Circle& bound,
                      double least_score, std::span<const int> keep, const Progress& progress) {
  FilmReader film(path);
  const auto workers = static_cast<std::size_t>(thread_limit());
  constexpr std::size_t kEach = 4;  // frames of a batch for each worker
  std::vector<std::unique_ptr<BallEyes>> eyes;
  for (std::size_t w = 0; w < workers; ++w) eyes.push_back(std::make_unique<BallEyes>());
  FilmPass pass;
  std::vector<cv::Mat> pictures(workers * kEach + 1);  // behind the last one of the batch before
  std::size_t count = 0;
  cv::Mat before_that;
  double expected = 0;
  bool more = true;
  while (more) {
    std::swap(pictures[0], pictures[count]);
    for (count = 0; count < workers * kEach && (more = film.next(pictures[count + 1])); ++count) {
      const cv::Mat &before = pictures[count], &picture = pictures[count + 1];
      const std::size_t f = pass.drum.size();
      DrumAngle angle;
      if (drum.reader != nullptr) {
        // The first ones have been followed to and fro already.
        angle = f < drum.angles.size() ? drum.angles[f] : (*drum.reader)(picture, expected, drum.turn_per_frame.value);
        expected = angle.angle + drum.turn_per_frame.value;
      }
      pass.drum.push_back(angle);
      const auto difference_to = [&](const cv::Mat& other) {
        return other.empty() ? kNotGiven : picture_difference(other, picture, bound.u, bound.v, bound.radius);
      };
      pass.difference.push_back(difference_to(before));
      pass.difference_over_two.push_back(difference_to(before_that));
      before.copyTo(before_that);  // its place is taken by a later picture
      if (std::binary_search(keep.begin(), keep.end(), static_cast<int>(f))) pass.kept.push_back(picture.clone());
    }
    std::vector<std::vector<FilmBall>> balls(count);
    parallel_for(workers, 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t w = from; w < to; ++w)
        for (std::size_t i = w; i < count; i += workers) {
          const cv::Mat& picture = pictures[i + 1];
          for (const Detection& d : detect_balls(*eyes[w], picture, look, bound, least_score).balls)
            balls[i].push_back({d, colour_of(picture, d), look_at_mark(picture, d.u, d.v, d.radius)});
        }
    });
    for (const auto& of_frame : balls) pass.balls.append(of_frame);
    report(progress, std::min(1.0, static_cast<double>(pass.frames()) / std::max(1, film.frame_count())));
  }
  return pass;
}

}  // namespace tumble::analysis
