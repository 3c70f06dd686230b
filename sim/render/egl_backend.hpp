#pragma once

#include <memory>

#include "sim/render/egl_library.hpp"
#include "sim/render/offscreen_backend.hpp"

namespace understory {

/// A context of EGL that draws into pbuffers. Throws std::runtime_error in one line where library, device or
/// context is missing.
std::unique_ptr<OffscreenBackend> egl_backend(EglDevice device);

}  // namespace understory
