#include "analysis/film_reader.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>

#include "core/config.h"
#include "core/error.h"

namespace tumble::analysis {
namespace {

constexpr int kLeastSide = 361;  // of the pictures handed out [px]: films of 360 lines and fewer are enlarged

// 16 bits to 8, grey and alpha to BGR: the rest of the room knows one kind of picture.
void to_bgr8(cv::Mat& picture) {
  if (picture.depth() == CV_16U) picture.convertTo(picture, CV_8U, 1.0 / 257.0);
  if (picture.channels() == 1) cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  if (picture.channels() == 4) cv::cvtColor(picture, picture, cv::COLOR_BGRA2BGR);
}

}  // namespace

FilmReader::FilmReader(const std::string& path) {
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (!std::filesystem::exists(status)) throw InputError(path, "there is no such file; give a film");
  if (std::filesystem::is_directory(status)) throw InputError(path, "is a folder; give a film, or a folder of stills");
  // What OpenCV and ffmpeg would print on a broken file is said by our own error.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // AV_LOG_QUIET
  bool opened = false;
  try {
    opened = capture_.open(path, cv::CAP_FFMPEG);
  } catch (const cv::Exception&) {
  }
  if (!opened) throw InputError(path, "cannot be read as a film; a video file was expected, such as MP4 with H.264");
  if (!decode(first_))
    throw InputError(path, "holds no picture that can be decoded; a film with at least one frame was expected");
  enlarged_ = std::clamp((kLeastSide - 1) / std::min(first_.rows, first_.cols) + 1, 1, 4);
  size_ = first_.size() * enlarged_;
  const double fps = capture_.get(cv::CAP_PROP_FPS);
  fps_ = fps > 0 && fps < 1e5 ? fps : kNotGiven;
  const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
  count_ = count > 0 && count < 1e8 ? static_cast<int>(count) : 0;
}

bool FilmReader::next(cv::Mat& picture) {
  if (!first_.empty()) {
    picture = std::move(first_);
    first_ = cv::Mat();
  } else if (!decode(picture)) {
    return false;
  }
  if (enlarged_ > 1) cv::resize(picture, picture, size_, 0, 0, cv::INTER_CUBIC);
  return true;
}

bool FilmReader::decode(cv::Mat& picture) {
  try {
    if (!capture_.read(picture) || picture.empty()) return false;
    to_bgr8(picture);
  } catch (const cv::Exception&) {
    return false;
  }
  return true;
}

}  // namespace tumble::analysis
