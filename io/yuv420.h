#pragma once
#include <cstdint>

#include "core/image.h"

namespace tumble::io {

// Three planes that someone else owns; chroma has half the width and height. Strides in bytes.
struct Yuv420 {
  std::uint8_t *y = nullptr, *cb = nullptr, *cr = nullptr;
  int y_stride = 0, cb_stride = 0, cr_stride = 0;
};

// R'G'B' to Y'CbCr by ITU-R BT.709, limited range (Y 16 to 235, C 16 to 240), in 16-bit fixed point: within one level
// of the exact value, the same on every machine. Chroma is the mean of 2 x 2 pixels, sited in their middle. Alpha is
// left out. The image's width and height must be even.
void yuv420_from_rgba(const Image& image, const Yuv420& planes);

}  // namespace tumble::io
