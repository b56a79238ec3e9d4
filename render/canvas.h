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
      : layout(plan), theme(inks), meshes(width, height), discs(width, height), text(width, height), height_(height) {
    glViewport(0, 0, width, height);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours are premultiplied
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_DITHER);
  }

  void paint_ground();  // over all
  void flush();         // meshes, then discs, then text

  // Between the two, nothing shows outside of whole pixels of the box; flush before either.
  void clip(const Box& box);
  void unclip();

  // From now on all goes into a drawing instead of being drawn; nullptr: no more.
  void record_into(Drawing* drawing);

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

 private:
  int height_;
  Drawing* drawing_ = nullptr;
};

}  // namespace tumble::render
