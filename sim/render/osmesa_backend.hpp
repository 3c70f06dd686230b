#pragma once

#include <memory>

#include "sim/render/offscreen_backend.hpp"

namespace understory {

/// A context of OSMesa, software that draws into memory of ours. Opens the library with dlopen. Throws
/// std::runtime_error in one line, naming the Debian package, where library or context cannot be had. The
/// environment's UNDERSTORY_OSMESA names another library file.
std::unique_ptr<OffscreenBackend> osmesa_backend();

}  // namespace understory
