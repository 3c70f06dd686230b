#pragma once

#include <string>

namespace understory {

/// libEGL as far as offscreen pictures need it, opened with dlopen, and the one display that this process
/// draws on. The names are those of the EGL specification.
struct EglLibrary {
  using Handle = void*;
  using Function = void (*)();
  Function (*get_proc_address)(const char* name) = nullptr;
  Handle (*create_pbuffer_surface)(Handle display, Handle config, const int* attributes) = nullptr;
  Handle (*create_context)(Handle display, Handle config, Handle share, const int* attributes) = nullptr;
  Handle (*get_current_context)() = nullptr;
  Handle (*get_current_surface)(int which) = nullptr;
  unsigned (*make_current)(Handle display, Handle draw, Handle read, Handle context) = nullptr;
  unsigned (*destroy_surface)(Handle display, Handle surface) = nullptr;
  unsigned (*destroy_context)(Handle display, Handle context) = nullptr;

  Handle display = nullptr;  ///< initialised
  Handle config = nullptr;   ///< 8 bits each of red, green, blue, alpha; 24 of depth; for pbuffers and OpenGL
};

enum class EglDevice {
  gpu,     ///< hardware or nothing
  any_one  ///< hardware where there is some, otherwise Mesa's software
};

/// The same library and display for the life of the process, whatever `device` says the second time. Throws
/// std::runtime_error in one line, naming the Debian packages, where there is none such. The environment's
/// UNDERSTORY_EGL names another library file.
const EglLibrary& egl_library(EglDevice device);

/// False where no EGL could find a GPU that this user may open: asked of the kernel's device files, so that
/// libEGL need not be opened to know.
bool has_gpu_device_file();

}  // namespace understory
