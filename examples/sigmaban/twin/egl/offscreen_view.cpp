#include "../offscreen_view.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "../../../../apps/common/usage_error.hpp"

namespace sigmaban {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw example::UsageError("nothing can be rendered here, EGL " + what +
                            "; install the Debian packages libegl1 and libgl1-mesa-dri");
}

/// OpenGL without a window.
class Context {
 public:
  Context() {
    // Mesa's surfaceless platform needs neither a screen nor a graphics card.
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) != EGL_TRUE) fail("has no display");
    constexpr std::array<EGLint, 7> wanted{EGL_SURFACE_TYPE,    EGL_PBUFFER_BIT, EGL_DEPTH_SIZE, 24,
                                           EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,  EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display_, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) fail("has no OpenGL");
    eglBindAPI(EGL_OPENGL_API);
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT || eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      fail("gives no context");
    }
  }
  ~Context() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

struct OffscreenView::Renderer {
  Renderer(const Twin& twin, int width, int height) : viewport{0, 0, width, height} {
    mjv_defaultScene(&scene);
    mjv_makeScene(&twin.model(), &scene, 200);
    mjr_defaultContext(&gpu);
    mjr_makeContext(&twin.model(), &gpu, mjFONTSCALE_100);
    mjr_setBuffer(mjFB_OFFSCREEN, &gpu);
    mjv_defaultOption(&option);
    mjv_defaultCamera(&camera);
    camera.distance = 1.0;   // [m]
    camera.azimuth = 130;    // [degrees]
    camera.elevation = -15;  // [degrees]
  }
  ~Renderer() {
    mjr_freeContext(&gpu);
    mjv_freeScene(&scene);
  }
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  Context context;  // first: the others need it
  mjvScene scene{};
  mjrContext gpu{};
  mjvOption option{};
  mjvCamera camera{};
  mjrRect viewport;
};

OffscreenView::OffscreenView(const Twin& twin, int width, int height)
    : renderer_(std::make_unique<Renderer>(twin, width, height)) {}

OffscreenView::~OffscreenView() = default;

Image OffscreenView::render(Twin& twin) {
  Renderer& r = *renderer_;
  const surefoot::Pose2 pose = twin.pose();
  r.camera.lookat[0] = pose.x;
  r.camera.lookat[1] = pose.y;
  r.camera.lookat[2] = 0.24;
  mjv_updateScene(&twin.model(), &twin.data(), &r.option, nullptr, &r.camera, mjCAT_ALL, &r.scene);
  mjr_render(r.viewport, &r.scene, &r.gpu);
  Image image{.width = r.viewport.width, .height = r.viewport.height, .pixels = {}};
  const std::size_t row = 3 * static_cast<std::size_t>(image.width), rows = static_cast<std::size_t>(image.height);
  image.pixels.resize(row * rows);
  mjr_readPixels(image.pixels.data(), nullptr, r.viewport, &r.gpu);
  for (std::size_t i = 0; i < rows / 2; ++i) {  // OpenGL's first row is the lowest
    const auto upper = image.pixels.begin() + static_cast<std::ptrdiff_t>(i * row);
    const auto lower = image.pixels.begin() + static_cast<std::ptrdiff_t>((rows - 1 - i) * row);
    std::swap_ranges(upper, upper + static_cast<std::ptrdiff_t>(row), lower);
  }
  return image;
}

}  // namespace sigmaban
