#include "render/still_layer.h"

#include <algorithm>
#include <cmath>

namespace tumble::render {

StillLayer::StillLayer(int width, int height) : width_(width), height_(height) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

// OSMesa's own buffer keeps its rows from the top, a texture from the bottom. The layer is kept upside down, so that
// both ways are plain copies of rows and not resampled.
void StillLayer::capture() {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  glBlitFramebuffer(0, 0, width_, height_, 0, height_, width_, 0, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void StillLayer::restore() const { restore({-0.5, -0.5, width_ - 0.5, height_ - 0.5}); }

void StillLayer::restore(const Box& box) const {
  const auto edge = [](double at, int size) { return std::clamp(static_cast<int>(std::lround(at + 0.5)), 0, size); };
  const int left = edge(box.left, width_), right = edge(box.right, width_);
  const int top = edge(box.top, height_), bottom = edge(box.bottom, height_);
  if (left >= right || top >= bottom) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(left, top, right, bottom, left, height_ - top, right, height_ - bottom, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace tumble::render
