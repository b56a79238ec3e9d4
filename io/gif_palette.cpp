#include "io/gif_palette.h"

#include <libimagequant.h>

#include <memory>

#include "core/error.h"

namespace tumble::io {
namespace {

constexpr int kColours = 255;

template <auto destroy>
struct Destroy {
  void operator()(auto* thing) const { destroy(thing); }
};

// Of the four values that share the upper six bits.
std::uint8_t middle(std::uint8_t channel) { return static_cast<std::uint8_t>((channel & 0xFCu) | 2u); }

void expect(liq_error error) {
  if (error != LIQ_OK) throw WorkError("GIF", "libimagequant finds no palette (error " + std::to_string(error) + ")");
}

}  // namespace

GifPalette::GifPalette(const std::vector<Image>& pictures) : known_(std::size_t{1} << 18, -1) {
  const std::unique_ptr<liq_attr, Destroy<liq_attr_destroy>> settings(liq_attr_create());
  if (!settings) throw WorkError("GIF", "no memory for a palette");
  expect(liq_set_max_colors(settings.get(), kColours));
  const std::unique_ptr<liq_histogram, Destroy<liq_histogram_destroy>> histogram(liq_histogram_create(settings.get()));
  for (const Image& picture : pictures) {
    const std::unique_ptr<liq_image, Destroy<liq_image_destroy>> image(
        liq_image_create_rgba(settings.get(), picture.rgba.data(), picture.width, picture.height, 0));
    if (!image) throw WorkError("GIF", "no memory for a palette");
    expect(liq_histogram_add_image(histogram.get(), settings.get(), image.get()));
  }
  liq_result* quantised = nullptr;
  expect(liq_histogram_quantize(histogram.get(), settings.get(), &quantised));
  const std::unique_ptr<liq_result, Destroy<liq_result_destroy>> result(quantised);
  const liq_palette* palette = liq_get_palette(result.get());
  count_ = static_cast<int>(palette->count);
  for (int i = 0; i < count_; ++i) {
    const liq_color& c = palette->entries[i];
    argb_[static_cast<std::size_t>(i)] =
        0xFF000000u | std::uint32_t{c.r} << 16 | std::uint32_t{c.g} << 8 | std::uint32_t{c.b};
  }
}

std::uint8_t GifPalette::nearest(std::uint8_t r, std::uint8_t g, std::uint8_t b) const {
  int best = 0, least = 1 << 30;
  for (int i = 0; i < count_; ++i) {
    const std::uint32_t c = argb_[static_cast<std::size_t>(i)];
    const int dr = static_cast<int>(c >> 16 & 255) - r, dg = static_cast<int>(c >> 8 & 255) - g,
              db = static_cast<int>(c & 255) - b;
    const int off = 2 * dr * dr + 4 * dg * dg + db * db;  // roughly as eyes weigh them
    if (off < least) {
      least = off;
      best = i;
    }
  }
  return static_cast<std::uint8_t>(best);
}

void GifPalette::map(const Image& picture, std::uint8_t* indices, int stride) {
  for (int v = 0; v < picture.height; ++v) {
    const std::uint8_t* p = picture.row(v);
    std::uint8_t* row = indices + static_cast<std::ptrdiff_t>(v) * stride;
    for (int u = 0; u < picture.width; ++u, p += 4) {
      const auto place = static_cast<std::size_t>(p[0] >> 2 << 12 | p[1] >> 2 << 6 | p[2] >> 2);
      if (known_[place] < 0)  // for the middle of those that share the place, whichever came first
        known_[place] = nearest(middle(p[0]), middle(p[1]), middle(p[2]));
      row[u] = static_cast<std::uint8_t>(known_[place]);
    }
  }
}

}  // namespace tumble::io
