#include "render/offscreen_context.h"

#include <fmt/format.h>

#include <cstdlib>
#include <mutex>

#include "core/error.h"
#include "render/gl.h"
// After the GL headers, which it needs.
#include <GL/osmesa.h>

namespace tumble::render {
namespace {

// Draws straight into the image: no read-back.
class OsmesaContext : public ContextMaker {
 public:
  OsmesaContext() {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              0,
                              OSMESA_STENCIL_BITS,
                              0,
                              OSMESA_ACCUM_BITS,
                              0,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    context_ = OSMesaCreateContextAttribs(attributes, nullptr);
    if (!context_) throw WorkError("render", "no OpenGL 3.3 core context from OSMesa; is libosmesa6 whole?");
  }
  ~OsmesaContext() override { OSMesaDestroyContext(context_); }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void make_current(Image& image) override {
    if (!OSMesaMakeCurrent(context_, image.rgba.data(), GL_UNSIGNED_BYTE, image.width, image.height)) {
      throw WorkError("render", fmt::format("OSMesa cannot draw a picture of {} x {} px", image.width, image.height));
    }
    OSMesaPixelStore(OSMESA_Y_UP, 0);  // rows from the top, as Image has them
  }
  void finish(Image&) override {
    glFinish();
    OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  }

 private:
  OSMesaContext context_ = nullptr;
};

}  // namespace

OffscreenContext::OffscreenContext(int width, int height, ContextKind kind) : image_(width, height) {
  // llvmpipe reads this once, with the first context. Its threads would cost more than they bring for pictures of this
  // size, and one context per thread scales better. An explicit wish of the user's environment stands.
  static std::once_flag once;
  std::call_once(once, [] { setenv("LP_NUM_THREADS", "0", 0); });
  if (kind == ContextKind::kEgl)
    maker_ = make_egl_context(width, height);
  else
    maker_ = std::make_unique<OsmesaContext>();
  make_current();  // what cannot be drawn is found here
  finish();
}

}  // namespace tumble::render
