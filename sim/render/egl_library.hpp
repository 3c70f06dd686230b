#pragma once

#include <string>

namespace understory {

/// The functions of libEGL that offscreen pictures need, opened with dlopen, and the one display on which
/// this process draws. Names are those of the EGL specification.
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

/// Library and display stay the same for the life of the process, whatever `device` a second call gives.
/// Throws std::runtime_error in one line, naming the Debian packages, where there is none. The environment
/// variable UNDERSTORY_EGL names another library file.
const EglLibrary& egl_library(EglDevice device);

/// False where no EGL could find a GPU that this user may open. It looks at the kernel's device files, so
/// that libEGL need not be opened.
bool has_gpu_device_file();

}  // namespace understory
