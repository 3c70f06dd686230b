#pragma once

#include <filesystem>

#include "tests/validation/section.hpp"

namespace understory {

/// docs/estimator.md: is the filter's uncertainty true, and how far does the map drift. `root`: the source
/// tree. Some 300 flights without a picture, two or three minutes on two cores.
ValidationPage estimator_page(const std::filesystem::path& root);

}  // namespace understory
