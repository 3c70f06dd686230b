#include "sim/render/egl_backend.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace understory {
namespace {

// From the EGL and OpenGL specifications.
constexpr int egl_width = 0x3057, egl_height = 0x3056, egl_none = 0x3038, egl_draw = 0x3059;
constexpr unsigned gl_rgba = 0x1908;
constexpr unsigned gl_unsigned_byte = 0x1401;

using ReadPixels = void (*)(int x, int y, int width, int height, unsigned format, unsigned type,
                            void* pixels);

class EglBackend : public OffscreenBackend {
 public:
  explicit EglBackend(EglDevice device)
      : egl_(egl_library(device)),
        context_(egl_.create_context(egl_.display, egl_.config, nullptr, nullptr)) {
    if (context_ == nullptr)
      throw std::runtime_error("EGL gave no OpenGL context: reinstall Debian's libgl1-mesa-dri");
  }
  ~EglBackend() override {
    if (egl_.get_current_context() == context_) egl_.make_current(egl_.display, nullptr, nullptr, nullptr);
    for (const auto& [size, surface] : surfaces_) egl_.destroy_surface(egl_.display, surface);
    egl_.destroy_context(egl_.display, context_);
  }

  RendererKind kind() const override { return RendererKind::egl; }

  void make_current(int width_px, int height_px) override {
    const EglLibrary::Handle surface = surface_of(width_px, height_px);
    if (egl_.get_current_context() == context_ && egl_.get_current_surface(egl_draw) == surface) return;
    width_px_ = width_px;
    height_px_ = height_px;
    pixels_.resize(static_cast<std::size_t>(width_px) * height_px * 4);
    if (!egl_.make_current(egl_.display, surface, surface, context_)) refuse(width_px, height_px);
  }

  const std::uint8_t* finished_pixels() override {
    as_function<ReadPixels>(function("glReadPixels"))(0, 0, width_px_, height_px_, gl_rgba, gl_unsigned_byte,
                                                      pixels_.data());
    return pixels_.data();
  }

  void* function(const char* name) const override {
    return reinterpret_cast<void*>(egl_.get_proc_address(name));
  }

 private:
  /// A surface of each size is kept: films alternate between two.
  EglLibrary::Handle surface_of(int width_px, int height_px) {
    EglLibrary::Handle& surface = surfaces_[{width_px, height_px}];
    if (surface != nullptr) return surface;
    const std::array<int, 5> size{egl_width, width_px, egl_height, height_px, egl_none};
    surface = egl_.create_pbuffer_surface(egl_.display, egl_.config, size.data());
    if (surface == nullptr) refuse(width_px, height_px);
    return surface;
  }

  [[noreturn]] static void refuse(int width_px, int height_px) {
    throw std::runtime_error("EGL refused a picture of " + std::to_string(width_px) + " x " +
                             std::to_string(height_px) + " pixels");
  }

  const EglLibrary& egl_;
  EglLibrary::Handle context_;
  std::map<std::pair<int, int>, EglLibrary::Handle> surfaces_;
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace

std::unique_ptr<OffscreenBackend> egl_backend(EglDevice device) {
  return std::make_unique<EglBackend>(device);
}

}  // namespace understory
