#pragma once

#include <filesystem>

#include "tests/validation/section.hpp"

namespace understory {

/// docs/model_mismatch.md: how often the aircraft still arrives, and how far its map drifts, where it is not
/// the one that the stack's model describes. `root`: the source tree, for the models and the scenario.
ValidationPage mismatch_page(const std::filesystem::path& root);

}  // namespace understory
