#include "render/theme.h"

#include <algorithm>

namespace tumble::render {

const Theme& dark_theme() {
  static const Theme theme{
      .ground = {14, 17, 22},
      .mill_inside = {37, 43, 53},
      .steel = {176, 186, 197},
      .text = {236, 240, 245},
      .quiet = {146, 156, 170},
      .faint = {52, 59, 70},
      .accent = {255, 179, 71},
      .second = {120, 214, 208},
      .trace = {111, 190, 230},
      .halo = {8, 10, 13},
      .force = {255, 112, 86},
      .flow = {236, 240, 245},
      .plate_brightness = 1,
      .magnitude = blend({{74, 82, 160},
                          {58, 116, 180},
                          {56, 152, 176},
                          {92, 184, 146},
                          {168, 208, 104},
                          {238, 218, 96},
                          {255, 244, 190}}),
      .of_sign = blend({{46, 108, 190}, {118, 170, 220}, {226, 228, 230}, {236, 160, 108}, {190, 66, 52}}),
  };
  return theme;
}

const Theme& light_theme() {
  static const Theme theme{
      .ground = {255, 255, 255},
      .mill_inside = {243, 245, 247},
      .steel = {176, 186, 197},
      .text = {22, 27, 34},
      .quiet = {86, 95, 108},
      .faint = {217, 222, 228},
      .accent = {168, 74, 0},
      .second = {0, 104, 112},
      .trace = {18, 98, 158},
      .halo = {255, 255, 255},
      .force = {196, 24, 34},
      .flow = {22, 27, 34},
      .plate_brightness = 1.6,
      // From pale to dark would turn slow balls into fast ones for whoever knows the dark picture: the hues keep their
      // order, and the bright end stays dark enough for a trail on paper.
      .magnitude =
          blend({{44, 36, 120}, {40, 84, 162}, {24, 124, 164}, {44, 152, 120}, {136, 170, 48}, {228, 158, 22}}),
      .of_sign = blend({{46, 108, 190}, {118, 170, 220}, {226, 228, 230}, {236, 160, 108}, {190, 66, 52}}),
  };
  return theme;
}

const Theme& theme_of(const Style& style) { return style.theme == ThemeName::kLight ? light_theme() : dark_theme(); }

double contrast(Rgba a, Rgba b) {
  const double p = luminance(a), q = luminance(b);
  return (std::max(p, q) + 0.05) / (std::min(p, q) + 0.05);
}

}  // namespace tumble::render
