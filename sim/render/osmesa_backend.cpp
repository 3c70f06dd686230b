#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/render/offscreen_backend.hpp"

namespace understory {
namespace {

constexpr int depth_bits = 24;

using CreateContext = void* (*)(unsigned format, int depth, int stencil, int accumulation, void* shared);
using MakeCurrent = unsigned char (*)(void* context, void* buffer, unsigned type, int width, int height);
using DestroyContext = void (*)(void* context);
using GetCurrentContext = void* (*)();
using GetProcAddress = void* (*)(const char* name);
using Finish = void (*)();

void* open_library() {
  // RTLD_GLOBAL: MuJoCo looks for OSMesaGetProcAddress among the process's global symbols.
  constexpr int mode = RTLD_NOW | RTLD_GLOBAL;
  if (const char* named = std::getenv("UNDERSTORY_OSMESA")) {
    if (void* library = dlopen(named, mode)) return library;
    throw std::runtime_error(std::string("UNDERSTORY_OSMESA names ") + named + ", which cannot be opened (" +
                             dlerror() + "): unset it and install Debian's libosmesa6");
  }
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
    if (void* library = dlopen(name, mode)) return library;
  const std::string reason = dlerror();
  throw std::runtime_error("no software OpenGL: libOSMesa.so.8 cannot be opened (" + reason +
                           "); install Debian's libosmesa6");
}

class OsmesaBackend : public OffscreenBackend {
 public:
  OsmesaBackend() : library_(open_library()) {
    auto* create = symbol<CreateContext>("OSMesaCreateContextExt");
    get_function_ = symbol<GetProcAddress>("OSMesaGetProcAddress");
    if (create == nullptr || get_function_ == nullptr)
      throw std::runtime_error("the OpenGL library opened is no OSMesa: install Debian's libosmesa6");
    context_ = create(gl_rgba, depth_bits, 0, 0, nullptr);
    if (context_ == nullptr)
      throw std::runtime_error("OSMesa gave no context: reinstall Debian's libosmesa6");
  }
  ~OsmesaBackend() override { symbol<DestroyContext>("OSMesaDestroyContext")(context_); }

  RendererKind kind() const override { return RendererKind::osmesa; }

  void make_current(int width_px, int height_px) override {
    const void* current = symbol<GetCurrentContext>("OSMesaGetCurrentContext")();
    if (current == context_ && width_px == width_px_ && height_px == height_px_) return;
    width_px_ = width_px;
    height_px_ = height_px;
    pixels_.resize(static_cast<std::size_t>(width_px) * height_px * 4);
    auto* make = symbol<MakeCurrent>("OSMesaMakeCurrent");
    if (!make(context_, pixels_.data(), gl_unsigned_byte, width_px, height_px))
      throw std::runtime_error("OSMesa refused a picture of " + std::to_string(width_px) + " x " +
                               std::to_string(height_px) + " pixels");
  }

  const std::uint8_t* finished_pixels() override {
    as_function<Finish>(function("glFinish"))();
    return pixels_.data();
  }

  void* function(const char* name) const override { return get_function_(name); }

 private:
  template <typename Function>
  Function symbol(const char* name) const {
    return as_function<Function>(dlsym(library_, name));
  }

  void* library_;
  GetProcAddress get_function_ = nullptr;
  void* context_ = nullptr;
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace

std::unique_ptr<OffscreenBackend> osmesa_backend() { return std::make_unique<OsmesaBackend>(); }

}  // namespace understory
