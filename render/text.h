#pragma once
#include <map>
#include <memory>
#include <string_view>
#include <tuple>
#include <vector>

#include "render/palette.h"
#include "render/recorder.h"
#include "render/shader.h"

namespace tumble::render {

enum class Weight { kRegular, kBold };
enum class Align { kLeft, kCentre, kRight };

struct TextStyle {
  double size = 12;  // em [px]
  Rgba colour;
  Weight weight = Weight::kRegular;
  Align align = Align::kLeft;
  Rgba halo{0, 0, 0, 0};  // round the letters, so that they read on anything
  double halo_width = 0;  // [px]
};

// UTF-8 text in DejaVu Sans by FreeType, each glyph rasterised once at its size and set on whole pixels: crisp.
class Text {
 public:
  Text(int width, int height);  // throws WorkError when the font is missing
  ~Text();

  // `x` is the left end, the middle or the right end, as aligned; `baseline` [px]. Drawn by the next flush().
  void add(std::string_view utf8, double x, double baseline, const TextStyle& style);
  double width(std::string_view utf8, const TextStyle& style);  // [px]
  void flush();
  void record_into(Drawing* drawing) { recorder_.record_into(drawing); }  // instead of drawing

 private:
  struct Glyph {
    int s = 0, t = 0, width = 0, height = 0;  // in the atlas [texel]
    int left = 0, top = 0, advance = 0;       // from the pen [px]
  };
  struct Vertex {
    float x, y, s, t;
    Rgba colour;
  };
  struct Fonts;
  const Glyph& glyph(char32_t character, int size, Weight weight);

  Pipeline pipeline_;
  Recorder recorder_;
  GLuint atlas_ = 0;
  int row_ = 0, row_height_ = 0, next_ = 0;  // where the atlas is still free [texel]
  std::unique_ptr<Fonts> fonts_;
  std::map<std::tuple<char32_t, int, Weight>, Glyph> glyphs_;
  std::vector<Vertex> vertices_;
};

}  // namespace tumble::render
