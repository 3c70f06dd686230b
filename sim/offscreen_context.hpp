#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace understory {

/// Which way the GL library works on this machine; the images are the same whatever the choice.
struct OffscreenOptions {
  /// Threads llvmpipe rasterises with beside the caller's; 0: none. One process flies one flight and a
  /// campaign runs one process a core, so helpers would only get into each other's way. An LP_NUM_THREADS set
  /// outside wins.
  int raster_threads = 0;
};

/// A software OpenGL context drawing into memory of ours: OSMesa, opened with dlopen so that nothing links GL
/// and the stack runs where it is missing. At most one should be current per thread.
class OffscreenContext {
 public:
  /// Throws std::runtime_error in one line, naming the Debian package, where the library or a context cannot
  /// be had. The environment's UNDERSTORY_OSMESA names another library file.
  explicit OffscreenContext(const OffscreenOptions& options = {});
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Makes the context current on this thread unless it is already, drawing into a picture of this size.
  void make_current(int width_px, int height_px);
  /// RGBA, 8 bits each, rows from the bottom up, of the size last made current; complete after finish().
  /// Where nothing was drawn, alpha is 0.
  const std::uint8_t* pixels() const { return pixels_.data(); }
  void finish() const;
  /// Textures are looked up in the nearest level of their pyramid, bilinearly: blending two levels doubles
  /// the cost.
  void use_nearest_mipmap(unsigned texture) const;
  std::string renderer() const;

 private:
  void* symbol(const char* name) const;

  void* library_ = nullptr;
  void* context_ = nullptr;
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace understory
