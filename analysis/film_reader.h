#pragma once
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string>

namespace tumble::analysis {

// Pictures of a film in order, 8-bit BGR. Small ones are enlarged: the balls of a small picture are too few pixels wide
// for edges to be told apart. All places then refer to the enlarged picture; `in_film` gives them back. Throws
// InputError where the file is no film or holds no frame.
class FilmReader {
 public:
  explicit FilmReader(const std::string& path);

  bool next(cv::Mat& picture);                       // false at the end; a film that breaks off ends there
  double frames_per_second() const { return fps_; }  // as the file says; NaN where it says nothing usable
  int frame_count() const { return count_; }         // as the file says; an estimate, 0 where unknown
  cv::Size size() const { return size_; }            // of the pictures handed out [px]
  int enlarged() const { return enlarged_; }         // times, along each side

 private:
  bool decode(cv::Mat& picture);

  cv::VideoCapture capture_;
  cv::Mat first_;  // read at once, to know that there is a picture
  double fps_ = 0;
  int count_ = 0;
  cv::Size size_;
  int enlarged_ = 1;
};

// A coordinate of an enlarged picture in the film's own pixels; integer = pixel centre in both.
inline double in_film(double coordinate, int enlarged) { return (coordinate + 0.5) / enlarged - 0.5; }

}  // namespace tumble::analysis
