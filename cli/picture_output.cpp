#include "cli/picture_output.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/image_file.h"

namespace tumble::cli {

OutputKind output_kind(const fs::path& output) {
  std::error_code error;
  if (!output.has_filename() || fs::is_directory(output, error)) return OutputKind::kFolder;
  if (io::is_film_name(output.string())) return OutputKind::kFilm;
  const fs::path extension = output.extension();
  if (extension == ".png") return OutputKind::kPicture;
  if (extension == ".svg" || extension == ".pdf") return OutputKind::kDrawing;
  throw InputError(
      output.string(),
      "is no .mp4, .webm, .gif, .png, .svg or .pdf; give FILM.mp4, STILL.png, or FRAMES/ for a folder of PNG");
}

std::string picture_name(std::size_t index) { return fmt::format("frame_{:06}.png", index); }

PictureOutput::PictureOutput(const fs::path& output, const io::FilmFormat& format)
    : output_(output), kind_(output_kind(output)) {
  if (kind_ == OutputKind::kFilm) film_ = std::make_unique<io::FilmWriter>(output.string(), format);
}

bool PictureOutput::can_be_cut() const { return !film_ || io::can_be_cut(output_.string()); }

void PictureOutput::put(std::size_t index, const Image& image) {
  if (film_)
    film_->write(image);
  else
    io::write_png((kind_ == OutputKind::kFolder ? output_ / picture_name(index) : output_).string(), image);
}

void PictureOutput::finish() {
  if (film_) film_->finish();
}

}  // namespace tumble::cli
