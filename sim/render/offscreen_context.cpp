#include "sim/render/offscreen_context.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "sim/render/offscreen_backend.hpp"

namespace understory {
namespace {

// From the OpenGL specification; the headers are not needed for so few.
constexpr unsigned gl_2d_texture = 0x0DE1;
constexpr unsigned gl_texture_min_filter = 0x2801;
constexpr int gl_linear_mipmap_nearest = 0x2701;
constexpr unsigned gl_rgb = 0x1907;
constexpr unsigned gl_unpack_alignment = 0x0CF5;
constexpr unsigned gl_renderer = 0x1F01;
constexpr unsigned gl_version = 0x1F02;

using BindTexture = void (*)(unsigned target, unsigned texture);
using Backend = std::unique_ptr<OffscreenBackend>;

/// A GPU, or nothing where the machine shows none or EGL cannot use it.
Backend gpu_backend() {
  if (!has_gpu_device_file()) return nullptr;
  try {
    return egl_backend(EglDevice::gpu);
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

/// OSMesa, or the other library where it is not installed.
Backend software_backend() {
  try {
    return osmesa_backend();
  } catch (const std::runtime_error& no_osmesa) {
    try {
      return egl_backend(EglDevice::any_one);
    } catch (const std::runtime_error&) {
      throw no_osmesa;
    }
  }
}

/// The two libraries break each other, and MuJoCo keeps the functions of one. All contexts of a process
/// therefore use the library of the first.
Backend backend_of(RendererKind kind) {
  static RendererKind opened = RendererKind::automatic;
  if (kind == RendererKind::automatic) kind = opened;
  if (opened != RendererKind::automatic && kind != opened)
    throw std::runtime_error("this process already draws through the other of OSMesa and EGL");
  Backend backend;
  if (kind == RendererKind::osmesa) backend = osmesa_backend();
  if (kind == RendererKind::egl) backend = egl_backend(EglDevice::any_one);
  if (kind == RendererKind::automatic) {
    backend = gpu_backend();
    if (backend == nullptr) backend = software_backend();
  }
  opened = backend->kind();
  return backend;
}

}  // namespace

std::set<std::string> variables_that_change_bits() {
  constexpr std::array beginnings{"GALLIUM_", "GALLIVM_",  "LP_",    "MESA_",
                                  "DRAW_",    "ST_DEBUG=", "LIBGL_", "GLIBC_TUNABLES="};
  constexpr std::array harmless{"GALLIUM_DRIVER=",  "LP_NUM_THREADS=", "MESA_SHADER_CACHE_",
                                "MESA_GLSL_CACHE_", "MESA_LOG",        "LIBGL_DEBUG="};
  std::set<std::string> set;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const auto begins = [&](const char* word) { return std::string_view(*variable).starts_with(word); };
    if (std::ranges::any_of(beginnings, begins) && std::ranges::none_of(harmless, begins))
      set.insert(*variable);
  }
  return set;
}

OffscreenContext::OffscreenContext(RendererKind renderer) {
  // A campaign runs one process a core, so more threads would only compete. Images do not depend on them.
  setenv("LP_NUM_THREADS", "0", 0);
  // These two end the process or slow it.
  for (const char* wrapper : {"GALLIUM_DDEBUG", "GALLIUM_TRACE"}) unsetenv(wrapper);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);  // Mesa's others crash without their device, or draw other bits
  backend_ = backend_of(renderer);
}

void OffscreenContext::upload_level(unsigned texture, int level, int width_px, int height_px,
                                    const std::uint8_t* rgb) const {
  using SetPixelStore = void (*)(unsigned name, int value);
  using TexImage = void (*)(unsigned target, int level, int internal_format, int width, int height,
                            int border, unsigned format, unsigned type, const void* pixels);
  as_function<BindTexture>(backend_->function("glBindTexture"))(gl_2d_texture, texture);
  as_function<SetPixelStore>(backend_->function("glPixelStorei"))(gl_unpack_alignment, 1);
  as_function<TexImage>(backend_->function("glTexImage2D"))(gl_2d_texture, level, gl_rgb, width_px, height_px,
                                                            0, gl_rgb, gl_unsigned_byte, rgb);
}

void OffscreenContext::use_nearest_mipmap(unsigned texture) const {
  using SetParameter = void (*)(unsigned target, unsigned name, int value);
  as_function<BindTexture>(backend_->function("glBindTexture"))(gl_2d_texture, texture);
  as_function<SetParameter>(backend_->function("glTexParameteri"))(gl_2d_texture, gl_texture_min_filter,
                                                                   gl_linear_mipmap_nearest);
}

std::string OffscreenContext::renderer() const {
  using GetString = const unsigned char* (*)(unsigned name);
  const auto get_string = as_function<GetString>(backend_->function("glGetString"));
  const auto text = [&](unsigned name) {
    const unsigned char* value = get_string(name);
    return value == nullptr ? std::string("?") : std::string(reinterpret_cast<const char*>(value));
  };
  std::string name = text(gl_renderer) + ", " + text(gl_version);
  for (const std::string& variable : variables_that_change_bits()) name += ", " + variable;
  return name;
}

std::string OffscreenContext::take_errors() const {
  const auto next = as_function<unsigned (*)()>(backend_->function("glGetError"));
  std::array<char, 32> first{};
  for (int i = 0; i < 100; ++i)  // without a context some libraries give errors for ever
    if (const unsigned error = next(); error == 0)
      break;
    else if (i == 0)
      std::snprintf(first.data(), first.size(), "OpenGL error 0x%x", error);
  return first.data();
}

}  // namespace understory
