#include "io/yuv420.h"

#include <cmath>
#include <cstddef>

namespace tumble::io {
namespace {

// BT.709 luma weights; the chroma scales follow from them (ITU-R BT.709-6, 3.2 to 3.4).
constexpr double kRed = 0.2126, kGreen = 0.7152, kBlue = 0.0722;
constexpr int kShift = 16;

constexpr std::int32_t fixed(double value) {
  return static_cast<std::int32_t>(value * (1 << kShift) + (value < 0 ? -0.5 : 0.5));
}

constexpr double kLumaScale = 219.0 / 255.0;
constexpr double kCbScale = 224.0 / 255.0 / (2 * (1 - kBlue)), kCrScale = 224.0 / 255.0 / (2 * (1 - kRed));
constexpr std::int32_t kYr = fixed(kRed * kLumaScale), kYg = fixed(kGreen * kLumaScale),
                       kYb = fixed(kBlue * kLumaScale);
constexpr std::int32_t kCbr = fixed(-kRed * kCbScale), kCbg = fixed(-kGreen * kCbScale), kCbb = -kCbr - kCbg;
constexpr std::int32_t kCrg = fixed(-kGreen * kCrScale), kCrb = fixed(-kBlue * kCrScale), kCrr = -kCrg - kCrb;
constexpr std::int32_t kHalf = 1 << (kShift - 1);

// Plain loops over one row or pair of rows, so that the compiler can vectorise them.
void luma_row(const std::uint8_t* rgba, std::uint8_t* y, int width) {
  for (int i = 0; i < width; ++i) {
    const std::int32_t r = rgba[4 * i], g = rgba[4 * i + 1], b = rgba[4 * i + 2];
    y[i] = static_cast<std::uint8_t>((kYr * r + kYg * g + kYb * b + (16 << kShift) + kHalf) >> kShift);
  }
}

void chroma_row(const std::uint8_t* above, const std::uint8_t* below, std::uint8_t* cb, std::uint8_t* cr, int width) {
  for (int i = 0; i < width / 2; ++i) {
    const std::uint8_t *p = above + 8 * i, *q = below + 8 * i;
    const std::int32_t r = p[0] + p[4] + q[0] + q[4], g = p[1] + p[5] + q[1] + q[5], b = p[2] + p[6] + q[2] + q[6];
    constexpr std::int32_t offset = (128 << (kShift + 2)) + 4 * kHalf;  // sums of four pixels
    cb[i] = static_cast<std::uint8_t>((kCbr * r + kCbg * g + kCbb * b + offset) >> (kShift + 2));
    cr[i] = static_cast<std::uint8_t>((kCrr * r + kCrg * g + kCrb * b + offset) >> (kShift + 2));
  }
}

}  // namespace

void yuv420_from_rgba(const Image& image, const Yuv420& planes) {
  for (int v = 0; v < image.height; v += 2) {
    luma_row(image.row(v), planes.y + static_cast<std::ptrdiff_t>(v) * planes.y_stride, image.width);
    luma_row(image.row(v + 1), planes.y + static_cast<std::ptrdiff_t>(v + 1) * planes.y_stride, image.width);
    chroma_row(image.row(v), image.row(v + 1), planes.cb + static_cast<std::ptrdiff_t>(v / 2) * planes.cb_stride,
               planes.cr + static_cast<std::ptrdiff_t>(v / 2) * planes.cr_stride, image.width);
  }
}

}  // namespace tumble::io
