#pragma once

#include <memory>

#include "sim/render/egl_library.hpp"
#include "sim/render/offscreen_backend.hpp"

namespace understory {

/// A context of EGL, drawing into pbuffers. Throws std::runtime_error in one line where library, device or
/// context cannot be had.
std::unique_ptr<OffscreenBackend> egl_backend(EglDevice device);

}  // namespace understory
