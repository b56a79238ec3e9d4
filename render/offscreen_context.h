#pragma once
#include "core/image.h"

struct osmesa_context;

namespace tumble::render {

// An OpenGL 3.3 core context without a window that draws straight into an Image: no read-back. OSMesa (llvmpipe)
// is one way to make it; EGL surfaceless would be a second source file behind the same header.
//
// A context may be built in one thread and used in another, but by one at a time; several contexts in several threads
// draw identical pixels, because the rasteriser's own threads are switched off.
class OffscreenContext {
 public:
  OffscreenContext(int width, int height);  // [px]; throws WorkError when it cannot be had
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  // GL calls belong between these two; finish() also puts the picture into image().
  void make_current();
  void finish();

  const Image& image() const { return image_; }

 private:
  osmesa_context* context_ = nullptr;
  Image image_;
};

// Makes the context current for a scope, so that no path leaves it bound to a thread.
class CurrentContext {
 public:
  explicit CurrentContext(OffscreenContext& context) : context_(context) { context_.make_current(); }
  ~CurrentContext() { context_.finish(); }
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

 private:
  OffscreenContext& context_;
};

}  // namespace tumble::render
