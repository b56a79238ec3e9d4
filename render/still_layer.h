#pragma once
#include "render/camera.h"
#include "render/gl.h"

namespace tumble::render {

// A copy of the picture kept by the rasteriser: what stands still is painted once and then copied row by row, ten
// times cheaper than drawing it. Frees itself with the context.
class StillLayer {
 public:
  StillLayer(int width, int height);
  void capture();                      // the picture as it is now
  void restore() const;                // all of it
  void restore(const Box& box) const;  // whole pixels of a part of it [px]

 private:
  int width_, height_;
  GLuint framebuffer_ = 0;
};

}  // namespace tumble::render
