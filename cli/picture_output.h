#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "core/image.h"
#include "io/film_file.h"

namespace tumble::cli {

namespace fs = std::filesystem;

// What `-o` asks for, by its name.
enum class OutputKind {
  kFilm,     // .mp4, .webm, .gif
  kFolder,   // FRAMES/ or a folder that is there: a PNG for every picture
  kPicture,  // .png
  kDrawing,  // .svg, .pdf
};
// Throws InputError for a name that is none of these.
OutputKind output_kind(const fs::path& output);

// Of a PNG in a folder of pictures: frame_000000.png.
std::string picture_name(std::size_t index);

// Pictures on their way to a film, to a folder that exists (by several threads in any order), or one picture to its
// file.
class PictureOutput {
 public:
  PictureOutput(const fs::path& output, const io::FilmFormat& format);
  void put(std::size_t index, const Image& image);  // of a film in order
  io::FilmWriter* film() { return film_.get(); }    // nullptr where it is none; takes parts too
  bool can_be_cut() const;                          // whether pictures need not come in order
  void finish();

 private:
  fs::path output_;
  OutputKind kind_;
  std::unique_ptr<io::FilmWriter> film_;
};

}  // namespace tumble::cli
