#pragma once
#include <string>
#include <vector>

#include "analysis/ball_detector.h"
#include "analysis/charge_motion.h"
#include "analysis/drum_motion.h"
#include "analysis/film_reader.h"

namespace tumble::analysis {

// What the first part of a film tells before its balls are followed.
struct FilmSurvey {
  int frames = 0;                 // looked at
  std::vector<RingEdge> rings;    // concentric circles of the mean picture, strongest first
  Circle centre;                  // of the mill; its radius bounds where balls are looked for
  std::vector<cv::Mat> samples;   // a few pictures, spread over the part looked at
  std::vector<DrumStrip> strips;  // one a frame, from just inside `centre.radius` to half of it
};

// Throws InputError where no mill is in view.
FilmSurvey survey_film(const std::string& path, const Progress& progress);

// Annuli that the strips of a survey cover [px].
inline double strip_inner(const Circle& bound) { return 0.76 * bound.radius; }
inline double strip_outer(const Circle& bound) { return 1.0 * bound.radius; }

// The mill's centre and the largest circle that encloses the drum, from its concentric edges.
Circle enclosing_circle(const std::vector<RingEdge>& rings);

}  // namespace tumble::analysis
