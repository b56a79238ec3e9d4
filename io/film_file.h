#pragma once
#include <memory>
#include <string>

#include "core/image.h"

namespace tumble::io {

struct FilmFormat {
  int width = 1280, height = 720;  // [px], even
  int fps_numerator = 60, fps_denominator = 1;
  std::string preset = "veryfast";  // x264's; the others have none
  double crf = 20;                  // constant rate factor, 0 (lossless) to 51 (x264) or 63 (VP9); GIF has none
  int threads = 0;                  // 1: encode inside write(); else beside it, in a thread of the writer's own
};

// What a film of this name is unless something else is wished: .mp4 (H.264), .webm (VP9), .gif. Throws InputError for
// any other name.
FilmFormat usual_format(const std::string& path);
bool is_film_name(const std::string& path);

// The coding follows the name. H.264 in MP4 and VP9 in WebM: yuv420p, bt709, index in front (faststart). GIF: for ever
// again from the start, in the 255 colours that suit its first pictures. Bytes do not depend on the number of threads.
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
