#include <dlfcn.h>
#include <unistd.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/render/offscreen_backend.hpp"

namespace understory {
namespace {

/// libEGL, opened with dlopen. The environment's UNDERSTORY_EGL names another library file.
class EglLibrary {
 public:
  EglLibrary() {
    const char* named = std::getenv("UNDERSTORY_EGL");
    file_ = named != nullptr ? named : "libEGL.so.1";
    library_ = dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library_ != nullptr) return;
    if (named != nullptr)
      throw std::runtime_error("UNDERSTORY_EGL names " + file_ +
                               ", which cannot be opened: unset it and install Debian's libegl1");
    throw std::runtime_error(
        "no EGL: libEGL.so.1 cannot be opened; install Debian's libegl1 and libgl1-mesa-dri");
  }
  /// MuJoCo looks for eglGetProcAddress among the process's global symbols.
  void make_global() const { dlopen(file_.c_str(), RTLD_NOW | RTLD_GLOBAL); }

  template <typename Function>
  Function core(const char* name) const {
    const auto function = as_function<Function>(dlsym(library_, name));
    if (function == nullptr)
      throw std::runtime_error("the OpenGL library opened is no EGL: install Debian's libegl1");
    return function;
  }
  /// Null where the library has no such extension.
  template <typename Function>
  Function extension(const char* name) const {
    return reinterpret_cast<Function>(core<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress")(name));
  }

 private:
  std::string file_;
  void* library_;
};

/// An initialised display and a configuration for OpenGL.
struct EglDisplay {
  EglLibrary library;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLConfig config = nullptr;
  bool is_surfaceless = false;  ///< a context can be current without a surface
};

/// Pictures are framebuffer objects: a surface is needed only where a context cannot be current without one.
EGLConfig config_of(const EglDisplay& egl) {
  const std::array<EGLint, 5> asked{EGL_SURFACE_TYPE, egl.is_surfaceless ? 0 : EGL_PBUFFER_BIT,
                                    EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  const auto choose = egl.library.core<PFNEGLCHOOSECONFIGPROC>("eglChooseConfig");
  return choose(egl.display, asked.data(), &config, 1, &count) && count == 1 ? config : nullptr;
}

std::vector<EGLDeviceEXT> gpus(const EglLibrary& egl) {
  const auto query = egl.extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto text = egl.extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (query == nullptr || text == nullptr ||
      !query(static_cast<EGLint>(devices.size()), devices.data(), &count))
    return {};
  std::vector<EGLDeviceEXT> hardware;
  for (int i = 0; i < count; ++i) {
    const char* has = text(devices[static_cast<std::size_t>(i)], EGL_EXTENSIONS);
    if (has != nullptr && std::strstr(has, "EGL_MESA_device_software") == nullptr)
      hardware.push_back(devices[static_cast<std::size_t>(i)]);
  }
  return hardware;
}

/// False where this one cannot be drawn on.
bool take(EglDisplay& egl, EGLDisplay display) {
  if (display == EGL_NO_DISPLAY ||
      !egl.library.core<PFNEGLINITIALIZEPROC>("eglInitialize")(display, nullptr, nullptr) ||
      !egl.library.core<PFNEGLBINDAPIPROC>("eglBindAPI")(EGL_OPENGL_API))
    return false;
  egl.display = display;
  const char* has = egl.library.core<PFNEGLQUERYSTRINGPROC>("eglQueryString")(display, EGL_EXTENSIONS);
  egl.is_surfaceless = has != nullptr && std::strstr(has, "EGL_KHR_surfaceless_context") != nullptr;
  egl.config = config_of(egl);
  return egl.config != nullptr;
}

/// Nothing where the device asked for is not there.
std::optional<EglDisplay> display_on(EglDevice device) {
  EglDisplay egl;
  const auto get_display = egl.library.extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get_display == nullptr) return std::nullopt;
  for (EGLDeviceEXT gpu : gpus(egl.library))
    if (take(egl, get_display(EGL_PLATFORM_DEVICE_EXT, gpu, nullptr))) return egl;
  if (device == EglDevice::any_one && take(egl, get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr)))
    return egl;
  return std::nullopt;
}

/// The same display for the life of the process, whatever `device` says the second time.
const EglDisplay& display_of_process(EglDevice device) {
  static std::optional<EglDisplay> chosen;
  if (chosen) return *chosen;
  chosen = display_on(device);
  if (!chosen)
    throw std::runtime_error(device == EglDevice::gpu
                                 ? "EGL finds no GPU to draw on"
                                 : "EGL gave no display to draw on: install Debian's libgl1-mesa-dri");
  chosen->library.make_global();
  return *chosen;
}

// From the OpenGL specification.
constexpr unsigned gl_renderbuffer = 0x8D41;
constexpr unsigned gl_rgba8 = 0x8058;
constexpr unsigned gl_depth24 = 0x81A6;
constexpr unsigned gl_color_attachment = 0x8CE0;
constexpr unsigned gl_depth_attachment = 0x8D00;
constexpr unsigned gl_framebuffer_complete = 0x8CD5;
constexpr unsigned gl_framebuffer_flip_y_mesa = 0x8BBB;
constexpr unsigned gl_extensions = 0x1F03;

/// Draws into framebuffer objects, of which it keeps one of each size: films alternate between two. No
/// surface is bound, for MuJoCo takes a pbuffer for a window and asks for buffers that it does not have.
class EglBackend : public OffscreenBackend {
 public:
  explicit EglBackend(EglDevice device)
      : egl_(display_of_process(device)),
        get_function_(core<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress")),
        current_context_(core<PFNEGLGETCURRENTCONTEXTPROC>("eglGetCurrentContext")),
        make_current_(core<PFNEGLMAKECURRENTPROC>("eglMakeCurrent")) {
    take_opengl();
    context_ =
        core<PFNEGLCREATECONTEXTPROC>("eglCreateContext")(egl_.display, egl_.config, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT)
      throw std::runtime_error("EGL gave no OpenGL context: reinstall Debian's libgl1-mesa-dri");
    const std::array<EGLint, 5> size{EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    if (!egl_.is_surfaceless)  // of no other use than to be bound
      surface_ = core<PFNEGLCREATEPBUFFERSURFACEPROC>("eglCreatePbufferSurface")(egl_.display, egl_.config,
                                                                                 size.data());
  }
  ~EglBackend() override {
    if (current_context_() == context_)
      make_current_(egl_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface_ != EGL_NO_SURFACE)
      core<PFNEGLDESTROYSURFACEPROC>("eglDestroySurface")(egl_.display, surface_);
    core<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext")(egl_.display, context_);
  }

  RendererKind kind() const override { return RendererKind::egl; }

  void make_current(int width_px, int height_px) override {
    const bool is_current = current_context_() == context_;
    if (is_current && width_px == width_px_ && height_px == height_px_) return;
    if (!is_current && !make_current_(egl_.display, surface_, surface_, context_))
      refuse(width_px, height_px);
    framebuffer_ = framebuffer_of(width_px, height_px);
    gl<void (*)(unsigned, unsigned)>("glBindFramebuffer")(gl_framebuffer, framebuffer_);
    width_px_ = width_px;
    height_px_ = height_px;
    pixels_.resize(static_cast<std::size_t>(width_px) * height_px * 4);
  }

  const std::uint8_t* finished_pixels() override {
    using ReadPixels =
        void (*)(int x, int y, int width, int height, unsigned format, unsigned type, void* pixels);
    gl<ReadPixels>("glReadPixels")(0, 0, width_px_, height_px_, gl_rgba, gl_unsigned_byte, pixels_.data());
    return pixels_.data();
  }

  unsigned framebuffer() const override { return framebuffer_; }

  void* function(const char* name) const override { return reinterpret_cast<void*>(get_function_(name)); }

 private:
  template <typename Function>
  Function core(const char* name) const {
    return egl_.library.core<Function>(name);
  }
  template <typename Function>
  Function gl(const char* name) const {
    return as_function<Function>(function(name));
  }

  /// EGL's choice of OpenGL holds for one thread. A thread that ends lets go of its context: another may have
  /// to delete it.
  void take_opengl() const {
    core<PFNEGLBINDAPIPROC>("eglBindAPI")(EGL_OPENGL_API);
    thread_local struct AtEnd {
      PFNEGLRELEASETHREADPROC release = nullptr;
      ~AtEnd() {
        if (release != nullptr) release();
      }
    } at_end;
    at_end.release = core<PFNEGLRELEASETHREADPROC>("eglReleaseThread");
  }

  /// The context deletes them with itself.
  unsigned framebuffer_of(int width_px, int height_px) {
    unsigned& framebuffer = framebuffers_[{width_px, height_px}];
    if (framebuffer != 0) return framebuffer;
    gl<void (*)(int, unsigned*)>("glGenFramebuffers")(1, &framebuffer);
    gl<void (*)(unsigned, unsigned)>("glBindFramebuffer")(gl_framebuffer, framebuffer);
    for (const auto& [attachment, format] :
         {std::pair(gl_color_attachment, gl_rgba8), std::pair(gl_depth_attachment, gl_depth24)}) {
      unsigned buffer = 0;
      gl<void (*)(int, unsigned*)>("glGenRenderbuffers")(1, &buffer);
      gl<void (*)(unsigned, unsigned)>("glBindRenderbuffer")(gl_renderbuffer, buffer);
      gl<void (*)(unsigned, unsigned, int, int)>("glRenderbufferStorage")(gl_renderbuffer, format, width_px,
                                                                          height_px);
      gl<void (*)(unsigned, unsigned, unsigned, unsigned)>("glFramebufferRenderbuffer")(
          gl_framebuffer, attachment, gl_renderbuffer, buffer);
    }
    // Mesa keeps a window's rows from the top, and rounds at edges accordingly: OSMesa's bits.
    const char* has = gl<const char* (*)(unsigned)>("glGetString")(gl_extensions);
    if (has != nullptr && std::strstr(has, "GL_MESA_framebuffer_flip_y") != nullptr)
      gl<void (*)(unsigned, unsigned, int)>("glFramebufferParameteri")(gl_framebuffer,
                                                                       gl_framebuffer_flip_y_mesa, 1);
    if (gl<unsigned (*)(unsigned)>("glCheckFramebufferStatus")(gl_framebuffer) != gl_framebuffer_complete)
      refuse(width_px, height_px);
    return framebuffer;
  }

  [[noreturn]] static void refuse(int width_px, int height_px) {
    throw std::runtime_error("EGL refused a picture of " + std::to_string(width_px) + " x " +
                             std::to_string(height_px) + " pixels");
  }

  const EglDisplay& egl_;
  PFNEGLGETPROCADDRESSPROC get_function_;
  PFNEGLGETCURRENTCONTEXTPROC current_context_;
  PFNEGLMAKECURRENTPROC make_current_;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
  std::map<std::pair<int, int>, unsigned> framebuffers_;
  unsigned framebuffer_ = 0;
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace

std::unique_ptr<OffscreenBackend> egl_backend(EglDevice device) {
  return std::make_unique<EglBackend>(device);
}

bool has_gpu_device_file() {
  namespace fs = std::filesystem;
  const auto usable = [](const fs::path& file) { return access(file.c_str(), R_OK | W_OK) == 0; };
  if (usable("/dev/nvidiactl") || usable("/dev/dxg")) return true;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev/dri", ignored))
    if (entry.path().filename().string().starts_with("renderD") && usable(entry.path())) return true;
  return false;
}

}  // namespace understory
