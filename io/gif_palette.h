#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/image.h"

namespace tumble::io {

// The 255 colours that stand best for all of some pictures (libimagequant), and the mapping to them; the 256th entry is
// left to GIF's transparency, by which a frame keeps what did not change.
class GifPalette {
 public:
  // Throws WorkError where libimagequant fails. The pictures have one size.
  explicit GifPalette(const std::vector<Image>& pictures);

  const std::array<std::uint32_t, 256>& argb() const { return argb_; }

  // The nearest colour of every pixel, no dithering: grain that jumps from frame to frame would cost more than it
  // brings. Rows of `indices` begin `stride` bytes apart.
  void map(const Image& picture, std::uint8_t* indices, int stride);

 private:
  std::uint8_t nearest(std::uint8_t r, std::uint8_t g, std::uint8_t b) const;

  int count_ = 0;
  std::array<std::uint32_t, 256> argb_{};
  std::vector<std::int16_t> known_;  // by colours of 6 bits a channel, once asked for; -1: not yet
};

}  // namespace tumble::io
