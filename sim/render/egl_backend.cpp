#include <dlfcn.h>
#include <unistd.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
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

/// An initialised display and its configuration for pictures without a window: 8 bits each of red, green,
/// blue and alpha, 24 of depth, for pbuffers and OpenGL.
struct EglDisplay {
  EglLibrary library;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLConfig config = nullptr;
};

/// EGL gives deeper colours first: takes what was asked for, not more.
EGLConfig config_of(const EglLibrary& egl, EGLDisplay display) {
  constexpr std::pair<EGLint, EGLint> exactly[] = {{EGL_RED_SIZE, 8},    {EGL_GREEN_SIZE, 8},
                                                   {EGL_BLUE_SIZE, 8},   {EGL_ALPHA_SIZE, 8},
                                                   {EGL_DEPTH_SIZE, 24}, {EGL_SAMPLES, 0}};
  std::vector<EGLint> asked{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT};
  for (const auto& [attribute, value] : exactly) asked.insert(asked.end(), {attribute, value});
  asked.push_back(EGL_NONE);
  std::array<EGLConfig, 256> configs{};
  EGLint count = 0;
  if (!egl.core<PFNEGLCHOOSECONFIGPROC>("eglChooseConfig")(display, asked.data(), configs.data(),
                                                           static_cast<EGLint>(configs.size()), &count))
    return nullptr;
  const auto get = egl.core<PFNEGLGETCONFIGATTRIBPROC>("eglGetConfigAttrib");
  const auto fits = [&](EGLConfig config) {
    return std::ranges::all_of(exactly, [&](const auto& wanted) {
      EGLint value = 0;
      return get(display, config, wanted.first, &value) && value == wanted.second;
    });
  };
  const auto found = std::find_if(configs.begin(), configs.begin() + count, fits);
  return found == configs.begin() + count ? nullptr : *found;
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
  egl.config = config_of(egl.library, display);
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

/// Draws into pbuffers.
class EglBackend : public OffscreenBackend {
 public:
  explicit EglBackend(EglDevice device)
      : egl_(display_of_process(device)),
        get_function_(core<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress")),
        current_context_(core<PFNEGLGETCURRENTCONTEXTPROC>("eglGetCurrentContext")),
        current_surface_(core<PFNEGLGETCURRENTSURFACEPROC>("eglGetCurrentSurface")),
        make_current_(core<PFNEGLMAKECURRENTPROC>("eglMakeCurrent")),
        context_(core<PFNEGLCREATECONTEXTPROC>("eglCreateContext")(egl_.display, egl_.config, EGL_NO_CONTEXT,
                                                                   nullptr)) {
    if (context_ == EGL_NO_CONTEXT)
      throw std::runtime_error("EGL gave no OpenGL context: reinstall Debian's libgl1-mesa-dri");
  }
  ~EglBackend() override {
    if (current_context_() == context_)
      make_current_(egl_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    for (const auto& [size, surface] : surfaces_)
      core<PFNEGLDESTROYSURFACEPROC>("eglDestroySurface")(egl_.display, surface);
    core<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext")(egl_.display, context_);
  }

  RendererKind kind() const override { return RendererKind::egl; }

  void make_current(int width_px, int height_px) override {
    EGLSurface surface = surface_of(width_px, height_px);
    if (current_context_() == context_ && current_surface_(EGL_DRAW) == surface) return;
    width_px_ = width_px;
    height_px_ = height_px;
    pixels_.resize(static_cast<std::size_t>(width_px) * height_px * 4);
    if (!make_current_(egl_.display, surface, surface, context_)) refuse(width_px, height_px);
  }

  const std::uint8_t* finished_pixels() override {
    using ReadPixels =
        void (*)(int x, int y, int width, int height, unsigned format, unsigned type, void* pixels);
    as_function<ReadPixels>(function("glReadPixels"))(0, 0, width_px_, height_px_, gl_rgba, gl_unsigned_byte,
                                                      pixels_.data());
    return pixels_.data();
  }

  void* function(const char* name) const override { return reinterpret_cast<void*>(get_function_(name)); }

 private:
  template <typename Function>
  Function core(const char* name) const {
    return egl_.library.core<Function>(name);
  }

  /// A surface of each size is kept: films alternate between two.
  EGLSurface surface_of(int width_px, int height_px) {
    EGLSurface& surface = surfaces_[{width_px, height_px}];
    if (surface != EGL_NO_SURFACE) return surface;
    const std::array<EGLint, 5> size{EGL_WIDTH, width_px, EGL_HEIGHT, height_px, EGL_NONE};
    surface = core<PFNEGLCREATEPBUFFERSURFACEPROC>("eglCreatePbufferSurface")(egl_.display, egl_.config,
                                                                              size.data());
    if (surface == EGL_NO_SURFACE) refuse(width_px, height_px);
    return surface;
  }

  [[noreturn]] static void refuse(int width_px, int height_px) {
    throw std::runtime_error("EGL refused a picture of " + std::to_string(width_px) + " x " +
                             std::to_string(height_px) + " pixels");
  }

  const EglDisplay& egl_;
  PFNEGLGETPROCADDRESSPROC get_function_;
  PFNEGLGETCURRENTCONTEXTPROC current_context_;
  PFNEGLGETCURRENTSURFACEPROC current_surface_;
  PFNEGLMAKECURRENTPROC make_current_;
  EGLContext context_;
  std::map<std::pair<int, int>, EGLSurface> surfaces_;
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
