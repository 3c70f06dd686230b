#pragma once

#include <filesystem>

#include "perception/io/rig_file.hpp"

namespace understory::support {

inline StereoRig house_rig(const char* name) {
  return read_rig(std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models/rigs" / name);
}

}  // namespace understory::support
