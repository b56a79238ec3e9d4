#include "render/text.h"

#include <fmt/format.h>
#include <ft2build.h>

#include <algorithm>
#include <cmath>
#include FT_FREETYPE_H

#include "core/error.h"

namespace tumble::render {
namespace {

constexpr const char* kRegularFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* kBoldFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
constexpr int kAtlasSize = 2048;  // [texel]; holds all glyphs of a 3840 x 2160 picture several times over

constexpr const char* kVertex = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 colour;
out vec2 place;
flat out vec4 ink;
void main() {
  place = texel;
  ink = colour;
  gl_Position = clip_from_image(position);
})";

// Texels fall on pixels one to one, so they are fetched, not filtered.
constexpr const char* kFragment = R"(
in vec2 place;
flat in vec4 ink;
uniform sampler2D atlas;
out vec4 pixel;
void main() {
  float cover = texelFetch(atlas, ivec2(floor(place)), 0).r * ink.a;
  pixel = vec4(ink.rgb * cover, cover);
})";

// The next code point of valid UTF-8; malformed bytes come out as they are.
char32_t next_character(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t length = lead < 0xC0 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  char32_t value = length == 1 ? lead : lead & (0xFFu >> (length + 1));
  if (length > text.size()) {
    text = {};
    return lead;
  }
  for (std::size_t i = 1; i < length; ++i) value = (value << 6) | (static_cast<unsigned char>(text[i]) & 0x3Fu);
  text.remove_prefix(length);
  return value;
}

}  // namespace

struct Text::Fonts {
  FT_Library library = nullptr;
  FT_Face regular = nullptr, bold = nullptr;

  Fonts() {
    if (FT_Init_FreeType(&library) != 0) throw WorkError("render", "FreeType does not start");
    for (auto [face, file] : {std::pair{&regular, kRegularFont}, std::pair{&bold, kBoldFont}}) {
      if (FT_New_Face(library, file, 0, face) != 0) {
        FT_Done_FreeType(library);
        throw WorkError(file, "font cannot be read; install the package fonts-dejavu-core");
      }
    }
  }
  ~Fonts() { FT_Done_FreeType(library); }  // and its faces
  Fonts(const Fonts&) = delete;
  Fonts& operator=(const Fonts&) = delete;
};

Text::Text(int width, int height)
    : pipeline_(make_pipeline(kVertex, kFragment, width, height)), fonts_(std::make_unique<Fonts>()) {
  set_attribute(pipeline_, 0, 2, GL_FLOAT, false, sizeof(Vertex), offsetof(Vertex, x));
  set_attribute(pipeline_, 1, 2, GL_FLOAT, false, sizeof(Vertex), offsetof(Vertex, s));
  set_attribute(pipeline_, 2, 4, GL_UNSIGNED_BYTE, true, sizeof(Vertex), offsetof(Vertex, colour));
  glGenTextures(1, &atlas_);
  glBindTexture(GL_TEXTURE_2D, atlas_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kAtlasSize, kAtlasSize, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
}

Text::~Text() = default;

const Text::Glyph& Text::glyph(char32_t character, int size, Weight weight) {
  const auto [place, is_new] = glyphs_.try_emplace({character, size, weight});
  Glyph& glyph = place->second;
  if (!is_new) return glyph;
  FT_Face face = weight == Weight::kBold ? fonts_->bold : fonts_->regular;
  FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size));
  if (FT_Load_Char(face, character, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) return glyph;
  const FT_Bitmap& bitmap = face->glyph->bitmap;
  glyph.width = static_cast<int>(bitmap.width);
  glyph.height = static_cast<int>(bitmap.rows);
  glyph.left = face->glyph->bitmap_left;
  glyph.top = face->glyph->bitmap_top;
  glyph.advance = static_cast<int>(std::lround(static_cast<double>(face->glyph->advance.x) / 64.0));
  if (next_ + glyph.width > kAtlasSize) {
    row_ += row_height_ + 1;
    next_ = row_height_ = 0;
  }
  if (row_ + glyph.height > kAtlasSize) throw WorkError("render", "too many kinds of text for one picture");
  glyph.s = next_;
  glyph.t = row_;
  next_ += glyph.width + 1;
  row_height_ = std::max(row_height_, glyph.height);
  glBindTexture(GL_TEXTURE_2D, atlas_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, bitmap.pitch);
  if (glyph.width > 0) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, glyph.s, glyph.t, glyph.width, glyph.height, GL_RED, GL_UNSIGNED_BYTE,
                    bitmap.buffer);
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  return glyph;
}

double Text::width(std::string_view utf8, const TextStyle& style) {
  const int size = static_cast<int>(std::lround(style.size));
  int width = 0;
  while (!utf8.empty()) width += glyph(next_character(utf8), size, style.weight).advance;
  return width;
}

void Text::add(std::string_view utf8, double x, double baseline, const TextStyle& style) {
  if (recorder_.is_on()) {
    const double anchor = style.align == Align::kLeft ? 0.0 : style.align == Align::kCentre ? 0.5 : 1.0;
    return recorder_.add(Drawing::Label{std::string(utf8),
                                        {x, baseline},
                                        style.size,
                                        style.weight == Weight::kBold,
                                        anchor,
                                        style.colour,
                                        style.halo,
                                        style.halo_width});
  }
  if (style.halo_width > 0) {
    const TextStyle behind{style.size, style.halo, style.weight, style.align};
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        if (dx != 0 || dy != 0) add(utf8, x + dx * style.halo_width, baseline + dy * style.halo_width, behind);
  }
  const int size = static_cast<int>(std::lround(style.size));
  if (style.align != Align::kLeft) x -= width(utf8, style) * (style.align == Align::kCentre ? 0.5 : 1.0);
  double pen = std::round(x);
  const double line = std::round(baseline);
  while (!utf8.empty()) {
    const Glyph& g = glyph(next_character(utf8), size, style.weight);
    const auto f = [](double value) { return static_cast<float>(value); };
    // Edges of pixels lie half a pixel from their centres.
    const float left = f(pen + g.left - 0.5), top = f(line - g.top - 0.5);
    const float right = left + f(g.width), bottom = top + f(g.height);
    const float s0 = f(g.s), t0 = f(g.t), s1 = f(g.s + g.width), t1 = f(g.t + g.height);
    const Vertex a{left, top, s0, t0, style.colour}, b{right, top, s1, t0, style.colour};
    const Vertex c{right, bottom, s1, t1, style.colour}, d{left, bottom, s0, t1, style.colour};
    vertices_.insert(vertices_.end(), {a, b, c, a, c, d});
    pen += g.advance;
  }
}

void Text::flush() {
  if (recorder_.is_on()) return recorder_.flush();
  if (vertices_.empty()) return;
  glUseProgram(pipeline_.program);
  glBindTexture(GL_TEXTURE_2D, atlas_);
  glBindVertexArray(pipeline_.vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, pipeline_.buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(Vertex)), vertices_.data(),
               GL_STREAM_DRAW);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices_.size()));
  vertices_.clear();
}

}  // namespace tumble::render
