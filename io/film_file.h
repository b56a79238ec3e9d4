#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "core/image.h"

namespace tumble::io {

struct FilmFormat {
  int width = 1280, height = 720;  // [px], even
  int fps_numerator = 60, fps_denominator = 1;
  std::string preset = "veryfast";  // x264's
  double crf = 20;                  // x264's constant rate factor, 0 to 51
  int threads = 0;                  // 1: write() encodes; else a thread of the writer's own beside it
};

// A stretch of a film that is encoded by itself: it begins with a key frame and asks nothing of its neighbours.
class FilmPart {
 public:
  FilmPart(FilmPart&&) noexcept;
  FilmPart& operator=(FilmPart&&) noexcept;
  ~FilmPart();

  void write(const Image& image);
  void finish();  // after its last picture

 private:
  friend class FilmWriter;
  struct Impl;
  explicit FilmPart(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// H.264 in MP4: yuv420p, bt709, index in front (faststart). Bytes do not depend on the number of threads.
// Written beside `path` and renamed by finish(); a writer that is destroyed unfinished leaves nothing.
//
// Pictures come in one by one to write(), or part by part: part() may be called and its parts filled by several
// threads at a time; append() takes finished parts in the film's order, one at a time. Where the parts are cut
// changes the bytes, so that must not hang on the number of threads.
class FilmWriter {
 public:
  FilmWriter(const std::string& path, const FilmFormat& format);
  ~FilmWriter();
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;

  void write(const Image& image);

  FilmPart part(std::int64_t first_frame);  // counted from the film's beginning
  void append(FilmPart part);

  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::io
