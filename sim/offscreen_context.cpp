#include "sim/offscreen_context.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>

namespace understory {
namespace {

// From the OpenGL and OSMesa specifications; the headers are not needed for so few.
constexpr unsigned gl_rgba = 0x1908;
constexpr unsigned gl_unsigned_byte = 0x1401;
constexpr unsigned gl_texture_2d = 0x0DE1;
constexpr unsigned gl_texture_min_filter = 0x2801;
constexpr int gl_linear_mipmap_nearest = 0x2701;
constexpr unsigned gl_renderer = 0x1F01;
constexpr unsigned gl_version = 0x1F02;
constexpr int depth_bits = 24;

using CreateContext = void* (*)(unsigned format, int depth, int stencil, int accumulation, void* shared);
using MakeCurrent = unsigned char (*)(void* context, void* buffer, unsigned type, int width, int height);
using DestroyContext = void (*)(void* context);
using GetProcAddress = void* (*)(const char* name);

template <typename Function>
Function as(void* address) {
  return reinterpret_cast<Function>(address);
}

void* open_library() {
  // RTLD_GLOBAL: MuJoCo looks for OSMesaGetProcAddress among the process's global symbols.
  constexpr int mode = RTLD_NOW | RTLD_GLOBAL;
  if (const char* named = std::getenv("UNDERSTORY_OSMESA")) {
    if (void* library = dlopen(named, mode)) return library;
    throw std::runtime_error(std::string("UNDERSTORY_OSMESA names ") + named +
                             ", which cannot be opened: unset it and install Debian's libosmesa6");
  }
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
    if (void* library = dlopen(name, mode)) return library;
  throw std::runtime_error(
      "no software OpenGL: libOSMesa.so.8 cannot be opened; install Debian's libosmesa6");
}

}  // namespace

OffscreenContext::OffscreenContext(const OffscreenOptions& options) {
  setenv("LP_NUM_THREADS", std::to_string(options.raster_threads).c_str(), 0);
  library_ = open_library();
  auto* create = as<CreateContext>(dlsym(library_, "OSMesaCreateContextExt"));
  if (create == nullptr || dlsym(library_, "OSMesaGetProcAddress") == nullptr)
    throw std::runtime_error("the OpenGL library opened is no OSMesa: install Debian's libosmesa6");
  context_ = create(gl_rgba, depth_bits, 0, 0, nullptr);
  if (context_ == nullptr) throw std::runtime_error("OSMesa gave no context: reinstall Debian's libosmesa6");
}

OffscreenContext::~OffscreenContext() {
  if (context_ != nullptr) as<DestroyContext>(dlsym(library_, "OSMesaDestroyContext"))(context_);
  // The library stays open: MuJoCo keeps pointers into it for the life of the process.
}

void OffscreenContext::make_current(int width_px, int height_px) {
  const auto current = as<void* (*)()>(dlsym(library_, "OSMesaGetCurrentContext"))();
  if (current == context_ && width_px == width_px_ && height_px == height_px_) return;
  width_px_ = width_px;
  height_px_ = height_px;
  pixels_.resize(static_cast<std::size_t>(width_px) * height_px * 4);
  auto* make = as<MakeCurrent>(dlsym(library_, "OSMesaMakeCurrent"));
  if (!make(context_, pixels_.data(), gl_unsigned_byte, width_px, height_px))
    throw std::runtime_error("OSMesa refused a picture of " + std::to_string(width_px) + " x " +
                             std::to_string(height_px) + " pixels");
}

void OffscreenContext::finish() const { as<void (*)()>(symbol("glFinish"))(); }

void OffscreenContext::use_nearest_mipmap(unsigned texture) const {
  as<void (*)(unsigned, unsigned)>(symbol("glBindTexture"))(gl_texture_2d, texture);
  as<void (*)(unsigned, unsigned, int)>(symbol("glTexParameteri"))(gl_texture_2d, gl_texture_min_filter,
                                                                   gl_linear_mipmap_nearest);
}

std::string OffscreenContext::renderer() const {
  auto* get_string = as<const unsigned char* (*)(unsigned)>(symbol("glGetString"));
  const auto text = [&](unsigned name) {
    const unsigned char* value = get_string(name);
    return value == nullptr ? std::string("?") : std::string(reinterpret_cast<const char*>(value));
  };
  return text(gl_renderer) + ", " + text(gl_version);
}

void* OffscreenContext::symbol(const char* name) const {
  return as<GetProcAddress>(dlsym(library_, "OSMesaGetProcAddress"))(name);
}

}  // namespace understory
