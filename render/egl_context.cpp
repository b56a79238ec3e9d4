#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <mutex>

#include "core/error.h"
#include "render/gl.h"
#include "render/offscreen_context.h"

// EGL on Mesa's surfaceless platform: no display, no window system; on a graphics card where Mesa has one. The picture
// is drawn into a pbuffer and read back. GL's functions come from libOSMesa here too: both go through Mesa's libglapi,
// which calls whatever context is current in the thread. Another vendor's EGL would not, so it is refused.
namespace tumble::render {
namespace {

[[noreturn]] void fail(const char* what) {
  throw WorkError("--context egl",
                  fmt::format("{} (EGL error {:#x}); install libegl-mesa0 and libgl1-mesa-dri, or use osmesa", what,
                              eglGetError()));
}

// One for the process, as EGL has it: several contexts share it.
EGLDisplay display() {
  static EGLDisplay opened = EGL_NO_DISPLAY;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  if (opened != EGL_NO_DISPLAY) return opened;
  const EGLDisplay found = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (found == EGL_NO_DISPLAY || !eglInitialize(found, nullptr, nullptr)) fail("there is no surfaceless platform");
  const char* vendor = eglQueryString(found, EGL_VENDOR);
  if (!vendor || !std::strstr(vendor, "Mesa")) fail("the surfaceless platform is not Mesa's");
  opened = found;
  return opened;
}

class EglContext : public ContextMaker {
 public:
  EglContext(int width, int height) : display_(display()) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_GREEN_SIZE,
                             8,
                             EGL_BLUE_SIZE,
                             8,
                             EGL_ALPHA_SIZE,
                             8,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    if (!eglChooseConfig(display_, wanted, &config, 1, &found) || found < 1) fail("it has no 8-bit RGBA pictures");
    const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    surface_ = eglCreatePbufferSurface(display_, config, size);
    if (surface_ == EGL_NO_SURFACE) fail("it cannot make a picture of this size");
    const EGLint version[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    eglBindAPI(EGL_OPENGL_API);  // of this thread
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT) {
      eglDestroySurface(display_, surface_);
      fail("it has no OpenGL 3.3 core");
    }
  }
  ~EglContext() override {
    eglDestroyContext(display_, context_);
    eglDestroySurface(display_, surface_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void make_current(Image&) override {
    eglBindAPI(EGL_OPENGL_API);
    if (!eglMakeCurrent(display_, surface_, surface_, context_)) fail("its context cannot be used");
  }

  void finish(Image& image) override {
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
    const std::size_t stride = static_cast<std::size_t>(image.width) * 4;  // OpenGL's rows begin at the bottom
    for (int v = 0; v < image.height / 2; ++v)
      std::swap_ranges(image.row(v), image.row(v) + stride, image.row(image.height - 1 - v));
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }

 private:
  EGLDisplay display_;
  EGLSurface surface_ = EGL_NO_SURFACE;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<ContextMaker> make_egl_context(int width, int height) {
  return std::make_unique<EglContext>(width, height);
}

}  // namespace tumble::render
