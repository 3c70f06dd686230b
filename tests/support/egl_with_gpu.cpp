/// libEGL on a machine that has a GPU, for machines that have none: its list of devices names a software
/// device and then a GPU, whose display is Mesa's own software. Each display that is asked for is a line in
/// the file that EGL_WITH_GPU_LOG names, each pbuffer another. With EGL_WITH_GPU_BROKEN set the GPU has no
/// display, as on a machine whose driver and kernel module do not match; with EGL_WITH_GPU_NEEDS_SURFACE no
/// context is current without a surface; with EGL_WITH_GPU_ERROR each context begins with an OpenGL error.
/// Everything else is the real library's.

#include <dlfcn.h>

#include <cstdlib>
#include <cstring>
#include <fstream>

namespace {

using Function = void (*)();
using GetProcAddress = Function (*)(const char* name);
using GetPlatformDisplay = void* (*)(unsigned platform, void* native, const int* attributes);

constexpr unsigned platform_surfaceless = 0x31DD;  // MESA_platform_surfaceless
int software_device, gpu_device;                   // their addresses are the handles

Function real_function(const char* name) {
  void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
  return reinterpret_cast<GetProcAddress>(dlsym(library, "eglGetProcAddress"))(name);
}

void note(const char* line) {
  if (const char* log = std::getenv("EGL_WITH_GPU_LOG")) std::ofstream(log, std::ios::app) << line << '\n';
}

/// A function of the library behind this one.
template <typename F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL), name));
}

unsigned query_devices(int room, void** devices, int* count) {
  if (room < 2) return 0;
  devices[0] = &software_device;
  devices[1] = &gpu_device;
  *count = 2;
  return 1;
}

const char* query_device_string(void* device, int) {
  return device == &software_device ? "EGL_MESA_device_software" : "EGL_EXT_device_drm";
}

void* get_platform_display(unsigned platform, void* native, const int* attributes) {
  const char* const asked = native == &gpu_device        ? "gpu"
                            : native == &software_device ? "software device"
                                                         : "surfaceless";
  note(asked);
  const bool device = native == &gpu_device || native == &software_device;
  if (native == &gpu_device && std::getenv("EGL_WITH_GPU_BROKEN") != nullptr) return nullptr;
  const auto real = reinterpret_cast<GetPlatformDisplay>(real_function("eglGetPlatformDisplayEXT"));
  return real(device ? platform_surfaceless : platform, device ? nullptr : native, attributes);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) Function eglGetProcAddress(const char* name) {
  if (std::strcmp(name, "eglQueryDevicesEXT") == 0) return reinterpret_cast<Function>(query_devices);
  if (std::strcmp(name, "eglQueryDeviceStringEXT") == 0)
    return reinterpret_cast<Function>(query_device_string);
  if (std::strcmp(name, "eglGetPlatformDisplayEXT") == 0)
    return reinterpret_cast<Function>(get_platform_display);
  return real_function(name);
}

extern "C" __attribute__((visibility("default"))) const char* eglQueryString(void* display, int name) {
  const char* text = next<const char* (*)(void*, int)>("eglQueryString")(display, name);
  constexpr int extensions = 0x3055;
  return name == extensions && std::getenv("EGL_WITH_GPU_NEEDS_SURFACE") != nullptr ? "EGL_KHR_image" : text;
}

extern "C" __attribute__((visibility("default"))) void* eglCreatePbufferSurface(void* display, void* config,
                                                                                const int* attributes) {
  note("pbuffer");
  return next<void* (*)(void*, void*, const int*)>("eglCreatePbufferSurface")(display, config, attributes);
}

extern "C" __attribute__((visibility("default"))) unsigned eglMakeCurrent(void* display, void* draw,
                                                                          void* read, void* context) {
  const unsigned done =
      next<unsigned (*)(void*, void*, void*, void*)>("eglMakeCurrent")(display, draw, read, context);
  if (std::getenv("EGL_WITH_GPU_ERROR") != nullptr && context != nullptr)
    reinterpret_cast<void (*)(unsigned)>(real_function("glEnable"))(0xFFFF);
  return done;
}
