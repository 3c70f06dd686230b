#include "sim/render/egl_library.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>

#include "sim/render/offscreen_backend.hpp"

namespace understory {
namespace {

using Handle = EglLibrary::Handle;

// From the EGL specification and its extensions EXT_platform_device, MESA_platform_surfaceless; the headers
// are not needed for so few.
constexpr unsigned platform_device = 0x313F;
constexpr unsigned platform_surfaceless = 0x31DD;
constexpr unsigned opengl_api = 0x30A2;
constexpr int extensions = 0x3055;
constexpr int none = 0x3038;
constexpr int red_size = 0x3024, green_size = 0x3023, blue_size = 0x3022, alpha_size = 0x3021;
constexpr int depth_size = 0x3025, samples = 0x3031;
constexpr int surface_type = 0x3033, pbuffer_bit = 1;
constexpr int renderable_type = 0x3040, opengl_bit = 8;

using QueryDevices = unsigned (*)(int room, Handle* devices, int* count);
using QueryDeviceString = const char* (*)(Handle device, int name);
using GetPlatformDisplay = Handle (*)(unsigned platform, Handle native, const int* attributes);
using Initialize = unsigned (*)(Handle display, int* major, int* minor);
using BindApi = unsigned (*)(unsigned api);
using ChooseConfig = unsigned (*)(Handle display, const int* attributes, Handle* configs, int room,
                                  int* count);
using GetConfigAttribute = unsigned (*)(Handle display, Handle config, int attribute, int* value);

class Opening {
 public:
  Opening() {
    const char* named = std::getenv("UNDERSTORY_EGL");
    library_ = dlopen(named != nullptr ? named : "libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (library_ != nullptr) return;
    if (named != nullptr)
      throw std::runtime_error(std::string("UNDERSTORY_EGL names ") + named +
                               ", which cannot be opened: unset it and install Debian's libegl1");
    throw std::runtime_error(
        "no EGL: libEGL.so.1 cannot be opened; install Debian's libegl1 and libgl1-mesa-dri");
  }

  /// Nothing where the device asked for is not there.
  std::optional<EglLibrary> on(EglDevice device) const {
    EglLibrary egl;
    take(egl.get_proc_address, "eglGetProcAddress");
    take(egl.create_pbuffer_surface, "eglCreatePbufferSurface");
    take(egl.create_context, "eglCreateContext");
    take(egl.get_current_context, "eglGetCurrentContext");
    take(egl.get_current_surface, "eglGetCurrentSurface");
    take(egl.make_current, "eglMakeCurrent");
    take(egl.destroy_surface, "eglDestroySurface");
    take(egl.destroy_context, "eglDestroyContext");
    const auto get_display = extension<GetPlatformDisplay>(egl, "eglGetPlatformDisplayEXT");
    if (get_display == nullptr) return std::nullopt;
    for (const Handle gpu : gpus(egl))
      if (initialise(egl, get_display(platform_device, gpu, nullptr))) return egl;
    if (device == EglDevice::any_one && initialise(egl, get_display(platform_surfaceless, nullptr, nullptr)))
      return egl;
    return std::nullopt;
  }

  /// MuJoCo looks for eglGetProcAddress among the process's global symbols.
  void make_global() const {
    const char* named = std::getenv("UNDERSTORY_EGL");
    dlopen(named != nullptr ? named : "libEGL.so.1", RTLD_NOW | RTLD_GLOBAL);
  }

 private:
  template <typename Function>
  void take(Function& function, const char* name) const {
    function = as_function<Function>(dlsym(library_, name));
    if (function == nullptr)
      throw std::runtime_error("the OpenGL library opened is no EGL: install Debian's libegl1");
  }
  template <typename Function>
  static Function extension(const EglLibrary& egl, const char* name) {
    return reinterpret_cast<Function>(egl.get_proc_address(name));
  }

  static std::vector<Handle> gpus(const EglLibrary& egl) {
    const auto query = extension<QueryDevices>(egl, "eglQueryDevicesEXT");
    const auto text = extension<QueryDeviceString>(egl, "eglQueryDeviceStringEXT");
    std::array<Handle, 32> devices{};
    int count = 0;
    if (query == nullptr || text == nullptr ||
        !query(static_cast<int>(devices.size()), devices.data(), &count))
      return {};
    std::vector<Handle> hardware;
    for (int i = 0; i < count; ++i) {
      const char* has = text(devices[static_cast<std::size_t>(i)], extensions);
      if (has != nullptr && std::strstr(has, "EGL_MESA_device_software") == nullptr)
        hardware.push_back(devices[static_cast<std::size_t>(i)]);
    }
    return hardware;
  }

  bool initialise(EglLibrary& egl, Handle display) const {
    Initialize initialize = nullptr;
    BindApi bind_api = nullptr;
    take(initialize, "eglInitialize");
    take(bind_api, "eglBindAPI");
    if (display == nullptr || !initialize(display, nullptr, nullptr) || !bind_api(opengl_api)) return false;
    egl.display = display;
    egl.config = config_of(display);
    return egl.config != nullptr;
  }

  /// EGL lists deeper colours first. Take exactly the requested depth.
  Handle config_of(Handle display) const {
    ChooseConfig choose = nullptr;
    GetConfigAttribute get = nullptr;
    take(choose, "eglChooseConfig");
    take(get, "eglGetConfigAttrib");
    const std::array<int, 15> asked{
        surface_type, pbuffer_bit, renderable_type, opengl_bit, red_size,   8,  green_size, 8,
        blue_size,    8,           alpha_size,      8,          depth_size, 24, none};
    std::array<Handle, 256> configs{};
    int count = 0;
    if (!choose(display, asked.data(), configs.data(), static_cast<int>(configs.size()), &count))
      return nullptr;
    const auto is = [&](Handle config, int attribute, int wanted) {
      int value = 0;
      return get(display, config, attribute, &value) && value == wanted;
    };
    for (int i = 0; i < count; ++i) {
      const Handle config = configs[static_cast<std::size_t>(i)];
      if (is(config, red_size, 8) && is(config, green_size, 8) && is(config, blue_size, 8) &&
          is(config, alpha_size, 8) && is(config, depth_size, 24) && is(config, samples, 0))
        return config;
    }
    return nullptr;
  }

  void* library_;
};

}  // namespace

const EglLibrary& egl_library(EglDevice device) {
  static std::optional<EglLibrary> chosen;
  if (chosen) return *chosen;
  const Opening opening;
  chosen = opening.on(device);
  if (!chosen)
    throw std::runtime_error(device == EglDevice::gpu
                                 ? "EGL finds no GPU to draw on"
                                 : "EGL gave no display to draw on: install Debian's libgl1-mesa-dri");
  opening.make_global();
  return *chosen;
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
