#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>

#include "sim/render/offscreen_backend.hpp"
#include "sim/render/renderer_kind.hpp"

namespace understory {

/// "NAME=VALUE" of the variables of the environment that are set and change what is drawn or computed.
std::set<std::string> variables_that_change_bits();

/// An OpenGL context that draws into memory, without a window: of OSMesa or EGL, opened with dlopen so that
/// nothing links GL and the stack runs where it is missing. At most one should be current per thread. A
/// process draws through one library: the first context's.
class OffscreenContext {
 public:
  /// Throws std::runtime_error in one line, naming the Debian package, where the library or a context cannot
  /// be had, or where this process already draws through the other library.
  explicit OffscreenContext(RendererKind renderer = RendererKind::osmesa);

  /// Makes the context current on this thread unless it is already, drawing into a picture of this size.
  void make_current(int width_px, int height_px) { backend_->make_current(width_px, height_px); }
  /// The finished picture: RGBA, 8 bits each, rows from the bottom up, of the size last made current. Valid
  /// until the next call of either function. Alpha is 0 where nothing was drawn.
  const std::uint8_t* finished_pixels() { return backend_->finished_pixels(); }
  /// Makes a level of a 2D texture, 0 the largest: RGB, 8 bits each, row after row without gaps.
  void upload_level(unsigned texture, int level, int width_px, int height_px, const std::uint8_t* rgb) const;
  /// Textures are looked up in the nearest level of their pyramid, bilinearly: blending two levels doubles
  /// the cost.
  void use_nearest_mipmap(unsigned texture) const;
  /// The OpenGL function of this name; the context must be current.
  void* function(const char* name) const { return backend_->function(name); }
  /// OpenGL's name of the framebuffer drawn into; 0: the context's own.
  unsigned framebuffer() const { return backend_->framebuffer(); }
  /// Returns and clears the errors of earlier OpenGL calls: "OpenGL error 0x502", or empty.
  std::string take_errors() const;
  /// Which library draws: osmesa or egl.
  RendererKind kind() const { return backend_->kind(); }
  /// The OpenGL implementation's own name and version, a GPU's with its driver's; behind them the variables
  /// of the environment that are set and change what is drawn or computed.
  std::string renderer() const;

 private:
  std::unique_ptr<OffscreenBackend> backend_;
};

}  // namespace understory
