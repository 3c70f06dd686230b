#pragma once

#include <filesystem>

#include "tests/validation/section.hpp"

namespace understory {

/// By how much the place of a remembered obstacle is off when it is passed: each switch of the filter as a
/// row, in three airs, beside FACTS section 4; against sight, wind and sensors; and what obstacles seen at a
/// second depth bring. `flights` of each air.
Section drift_section(const std::filesystem::path& root, int flights);

}  // namespace understory
