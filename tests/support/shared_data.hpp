#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace understory::support {

/// Recorded data that may not be in the repository: `path` below $UNDERSTORY_DATA, or below ../shared/data
/// beside it. Empty where it is not there; a test then says GTEST_SKIP() << missing_data(path).
std::optional<std::filesystem::path> shared_data(const std::string& path);
std::string missing_data(const std::string& path);

}  // namespace understory::support
