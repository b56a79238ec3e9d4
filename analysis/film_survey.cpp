#include "analysis/film_survey.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace tumble::analysis {
namespace {

constexpr int kMostFrames = 300;  // looked at: enough for lifters to wash out of the mean and for the drum's turn
constexpr std::size_t kSamples = 4;

}  // namespace

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

FilmSurvey survey_film(const std::string& path, const Progress& progress) {
  FilmSurvey survey;
  cv::Mat mean;
  {
    FilmReader film(path);
    cv::Mat picture, grey;
    std::size_t every = 1;
    while (survey.frames < kMostFrames && film.next(picture)) {
      cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
      if (mean.empty()) mean = cv::Mat::zeros(grey.size(), CV_32F);
      cv::accumulate(grey, mean);
      if (static_cast<std::size_t>(survey.frames) % every == 0) {
        if (survey.samples.size() == 2 * kSamples) {  // thin out, so that they stay spread over what was seen
          for (std::size_t i = 0; i < kSamples; ++i) survey.samples[i] = survey.samples[2 * i];
          survey.samples.resize(kSamples);
          every *= 2;
        }
        if (static_cast<std::size_t>(survey.frames) % every == 0) survey.samples.push_back(picture.clone());
      }
      ++survey.frames;
      report(progress, 0.5 * survey.frames / kMostFrames);
    }
  }
  mean /= survey.frames;
  survey.rings = find_concentric_circles(mean, 0.12 * std::min(mean.rows, mean.cols));
  survey.centre = enclosing_circle(survey.rings);
  if (!(survey.centre.radius > 0))
    throw InputError(
        path, "shows no mill; a view along the mill's axis was expected, with most of its round shell in the picture");

  const DrumUnroller unroll(survey.centre, strip_inner(survey.centre), strip_outer(survey.centre), mean.size());
  FilmReader film(path);
  cv::Mat picture;
  for (int f = 0; f < survey.frames && film.next(picture); ++f) {
    survey.strips.push_back(unroll(picture));
    report(progress, 0.5 + 0.5 * f / survey.frames);
  }
  return survey;
}

}  // namespace tumble::analysis
