#include "tests/support/shared_data.hpp"

#include <cstdlib>

namespace understory::support {

std::optional<std::filesystem::path> shared_data(const std::string& path) {
  const char* given = std::getenv("UNDERSTORY_DATA");
  const std::filesystem::path folder =
      given != nullptr ? given : std::filesystem::path(UNDERSTORY_SOURCE_DIR) / ".." / "shared" / "data";
  std::error_code ignored;
  if (!std::filesystem::exists(folder / path, ignored)) return std::nullopt;
  return folder / path;
}

std::string missing_data(const std::string& path) {
  return path + " is neither in $UNDERSTORY_DATA nor in ../shared/data";
}

}  // namespace understory::support
