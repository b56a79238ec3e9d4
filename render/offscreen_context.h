#pragma once
#include <memory>

#include "core/image.h"

namespace tumble::render {

enum class ContextKind {
  kOsmesa,  // llvmpipe on the CPU: everywhere the same, needs neither display nor driver
  kEgl,     // EGL without a surface to show, on whatever Mesa drives: a graphics card, else llvmpipe too
};

// One way to make a context; offscreen_context.cpp and egl_context.cpp each hold one.
class ContextMaker {
 public:
  virtual ~ContextMaker() = default;
  virtual void make_current(Image& image) = 0;
  virtual void finish(Image& image) = 0;  // the picture is in the image, and no context is current
};
std::unique_ptr<ContextMaker> make_egl_context(int width, int height);

// An OpenGL 3.3 core context without a window, and the picture that is drawn with it.
//
// A context may be built in one thread and used in another, but by one at a time; several contexts in several threads
// draw identical pixels, because the rasteriser's own threads are switched off.
class OffscreenContext {
 public:
  // [px]; throws WorkError when it cannot be had
  OffscreenContext(int width, int height, ContextKind kind = ContextKind::kOsmesa);

  // GL calls belong between these two; finish() also puts the picture into image().
  void make_current() { maker_->make_current(image_); }
  void finish() { maker_->finish(image_); }

  const Image& image() const { return image_; }

 private:
  Image image_;
  std::unique_ptr<ContextMaker> maker_;
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
