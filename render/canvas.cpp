#include "render/canvas.h"

#include <cmath>

namespace tumble::render {

void Canvas::paint_ground() {
  const auto share = [](std::uint8_t channel) { return static_cast<float>(channel) / 255.0f; };
  glClearColor(share(theme.ground.r), share(theme.ground.g), share(theme.ground.b), 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

void Canvas::flush() {
  meshes.flush();
  discs.flush();
  text.flush();
}

void Canvas::clip(const Box& box) {
  if (drawing_) {
    drawing_->shapes.emplace_back(Drawing::Enter{{0, 0}, box.left, box.top, box.right, box.bottom});
    return;
  }
  const auto edge = [](double at) { return static_cast<int>(std::lround(at + 0.5)); };
  const int left = edge(box.left), top = edge(box.top);
  glEnable(GL_SCISSOR_TEST);
  glScissor(left, height_ - edge(box.bottom), edge(box.right) - left, edge(box.bottom) - top);
}

void Canvas::unclip() {
  if (drawing_)
    drawing_->shapes.emplace_back(Drawing::Leave{});
  else
    glDisable(GL_SCISSOR_TEST);
}

void Canvas::record_into(Drawing* drawing) {
  drawing_ = drawing;
  meshes.record_into(drawing);
  discs.record_into(drawing);
  text.record_into(drawing);
}

}  // namespace tumble::render
