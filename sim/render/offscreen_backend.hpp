#pragma once

#include <cstdint>
#include <memory>

#include "sim/render/renderer_kind.hpp"

namespace understory {

/// One OpenGL context of one of the libraries that give contexts without a window. The library stays open for
/// the life of the process: MuJoCo keeps pointers into it.
class OffscreenBackend {
 public:
  virtual ~OffscreenBackend() = default;

  /// Which of the two libraries: osmesa or egl.
  virtual RendererKind kind() const = 0;
  /// Makes the context current on this thread unless it is already, and binds framebuffer(): a picture of
  /// this size, RGBA, 8 bits each, and 24 bits of depth. Throws std::runtime_error where the library refuses.
  virtual void make_current(int width_px, int height_px) = 0;
  /// The finished picture: RGBA, rows from the bottom up, of the size last made current. Valid until the next
  /// call of either function.
  virtual const std::uint8_t* finished_pixels() = 0;
  /// OpenGL's name of the framebuffer that make_current() bound; 0: the context's own.
  virtual unsigned framebuffer() const { return 0; }
  /// The OpenGL function of this name; the context must be current.
  virtual void* function(const char* name) const = 0;
};

/// A function of a library as a pointer of its type.
template <typename Function>
Function as_function(void* address) {
  return reinterpret_cast<Function>(address);
}

// From the OpenGL specification: so few constants do not need the headers.
constexpr unsigned gl_rgba = 0x1908;
constexpr unsigned gl_unsigned_byte = 0x1401;
constexpr unsigned gl_framebuffer = 0x8D40;

/// A context of OSMesa: software that draws into memory of ours. Opens the library with dlopen; the
/// environment's UNDERSTORY_OSMESA names another file. Throws std::runtime_error in one line where library or
/// context cannot be had.
std::unique_ptr<OffscreenBackend> osmesa_backend();

enum class EglDevice {
  gpu,     ///< hardware only
  any_one  ///< hardware if there is some, otherwise Mesa's software
};

/// A context of EGL, drawing into framebuffer objects. Throws std::runtime_error in one line, naming the
/// Debian packages, where library, device or context cannot be had. The process keeps to its first device.
std::unique_ptr<OffscreenBackend> egl_backend(EglDevice device);

/// False if EGL cannot find a GPU that this user may open. It checks the kernel's device files, so that
/// libEGL need not be opened for this.
bool has_gpu_device_file();

}  // namespace understory
