#pragma once
#include <memory>
#include <string>

#include "core/image.h"

namespace tumble::io {

struct FilmFormat {
  int width = 1280, height = 720;  // [px], even
  int fps_numerator = 60, fps_denominator = 1;
  std::string preset = "veryfast";  // x264's
  double crf = 20;                  // x264's constant rate factor, 0 to 51
  int threads = 0;                  // 1: encode inside write(); else beside it, in a thread of the writer's own
};

// H.264 in MP4: yuv420p, bt709, index in front (faststart). Bytes do not depend on the number of threads.
// Written beside `path` and renamed by finish(); a writer that is destroyed unfinished leaves nothing.
class FilmWriter {
 public:
  FilmWriter(const std::string& path, const FilmFormat& format);
  ~FilmWriter();
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;

  void write(const Image& image);
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::io
