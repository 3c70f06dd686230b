#pragma once

#include <filesystem>

#include "tests/validation/section.hpp"

namespace understory {

/// docs/flight_model.md: the simulated delta wing beside what is known of the real one. `root`: the source
/// tree, for the models and the flight record.
ValidationPage aircraft_page(const std::filesystem::path& root);

}  // namespace understory
