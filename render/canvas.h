#pragma once
#include <algorithm>

#include "render/camera.h"
#include "render/discs.h"
#include "render/meshes.h"
#include "render/text.h"
#include "render/theme.h"

namespace tumble::render {

// All that a part of the picture needs to draw itself: the primitives and the plan. Parts add; the renderer decides
// when each kind is flushed, and so what lies above what.
struct Canvas {
  Canvas(int width, int height, const Layout& plan, const Theme& inks)
      : layout(plan), theme(inks), meshes(width, height), discs(width, height), text(width, height) {}

  double px(double units) const { return units * layout.unit; }
  // Widths of strokes: in proportion, but never so thin that they vanish.
  double stroke(double units) const { return std::max(units * layout.unit, 0.75); }
  // Sizes of letters: in proportion, but always legible.
  double letter(double units) const { return std::max(units * layout.unit, 9.0); }

  Layout layout;
  const Theme& theme;
  Meshes meshes;
  Discs discs;
  Text text;
};

}  // namespace tumble::render
