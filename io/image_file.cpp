#include "io/image_file.h"

#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/error.h"
#include "io/output.h"

namespace tumble::io {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// libpng leaves by longjmp, so nothing with a destructor may live in here. False when something could not be written.
bool write_rows(std::FILE* file, const Image& image) {
  png_structp png = png_create_write_struct(
      PNG_LIBPNG_VER_STRING, nullptr, [](png_structp p, png_const_charp) { png_longjmp(p, 1); },
      [](png_structp, png_const_charp) {});
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(png, 6);
  png_write_info(png, info);
  png_set_filler(png, 0, PNG_FILLER_AFTER);  // pictures are opaque: alpha stays out of the file
  for (int v = 0; v < image.height; ++v) png_write_row(png, image.row(v));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

void write_png(const std::string& path, const Image& image) {
  const auto fail = [&path](int why) {
    throw WorkError(path, std::string("cannot be written: ") + (why ? std::strerror(why) : "libpng gave up"));
  };
  StagedFile staged(path);
  std::unique_ptr<std::FILE, Close> file(std::fopen(staged.path().c_str(), "wb"));
  if (!file) fail(errno);
  errno = 0;
  if (!write_rows(file.get(), image)) fail(errno);
  if (std::fclose(file.release()) != 0) fail(errno);
  staged.commit();
}

}  // namespace tumble::io
