#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scenarios/config/config_tree.hpp"

namespace understory {

/// A JSON text's value, discarded (is_discarded()) where the text is broken or nests more than 16 levels.
/// Files that are large are refused before: read_file(file, maximum_json_bytes).
nlohmann::ordered_json parse_json(const std::string& text);

}  // namespace understory
