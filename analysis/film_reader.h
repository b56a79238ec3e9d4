#pragma once
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string>

namespace tumble::analysis {

// Pictures of a film in order, 8-bit BGR. Throws InputError where the file is no film or holds no frame.
class FilmReader {
 public:
  explicit FilmReader(const std::string& path);

  bool next(cv::Mat& picture);                       // false at the end; a film that breaks off ends there
  double frames_per_second() const { return fps_; }  // as the file says; NaN where it says nothing usable
  int frame_count() const { return count_; }         // as the file says; an estimate, 0 where unknown
  cv::Size size() const { return size_; }

 private:
  cv::VideoCapture capture_;
  cv::Mat first_;  // read at once, to know that there is a picture
  double fps_ = 0;
  int count_ = 0;
  cv::Size size_;
};

}  // namespace tumble::analysis
