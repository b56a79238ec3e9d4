#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

// A picture: RGBA, 8 bits a channel, sRGB, rows from the top. Pixel (u, v) has its centre at integer u, v.
struct Image {
  int width = 0;   // [px]
  int height = 0;  // [px]
  std::vector<std::uint8_t> rgba;

  Image() = default;
  Image(int w, int h) : width(w), height(h), rgba(static_cast<std::size_t>(w) * h * 4) {}
  const std::uint8_t* row(int v) const { return rgba.data() + static_cast<std::size_t>(v) * width * 4; }
  std::uint8_t* row(int v) { return rgba.data() + static_cast<std::size_t>(v) * width * 4; }
};

}  // namespace tumble
