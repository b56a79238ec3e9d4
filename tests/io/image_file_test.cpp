#include "io/image_file.h"

#include <png.h>

#include <cstdint>

#include "core/error.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

using ImageFile = InFolder;

Image slope() {
  Image image(33, 7);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 9 : i * 7);
  return image;
}

TEST_F(ImageFile, GivesBackThePictureWithoutItsAlpha) {
  const std::string path = (folder_ / "still.png").string();
  const Image image = slope();
  write_png(path, image);
  png_image read{};
  read.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&read, path.c_str()));
  EXPECT_EQ(read.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
  read.format = PNG_FORMAT_RGBA;
  Image back(static_cast<int>(read.width), static_cast<int>(read.height));
  ASSERT_TRUE(png_image_finish_read(&read, nullptr, back.rgba.data(), 0, nullptr));
  ASSERT_EQ(back.width, 33);
  ASSERT_EQ(back.height, 7);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    EXPECT_EQ(back.rgba[i], i % 4 == 3 ? 255 : image.rgba[i]) << i;
  }
}

TEST_F(ImageFile, NamesThePathThatCannotBeWritten) {
  const std::string path = (folder_ / "missing" / "still.png").string();
  try {
    write_png(path, slope());
    FAIL();
  } catch (const WorkError& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tumble::io
