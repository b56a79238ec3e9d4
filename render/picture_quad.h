#pragma once
#include "core/image.h"
#include "render/shader.h"

namespace tumble::render {

// A picture laid into the picture, pixel on pixel, over what is there.
class PictureQuad {
 public:
  PictureQuad(int width, int height);  // of the whole picture [px]
  void draw(const Image& image, int left, int top);

 private:
  Pipeline pipeline_;
  GLuint texture_ = 0;
};

}  // namespace tumble::render
