#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace understory {

/// The result of one check of one part.
struct PartCheck {
  std::string part;   ///< "detector 'mine'"
  std::string check;  ///< "equal inputs give equal outputs"
  std::string fault;  ///< empty: passed
  std::string note;   ///< what was measured; may be empty
};

struct PartCheckOptions {
  std::filesystem::path models_folder;
  std::string plugin;  ///< parts that came from this file; empty: ours
  int calls = 10'000;  ///< of the check for memory; fewer of slow parts
  std::function<void(const std::string&)> on_progress = [](const std::string&) {};
};

/// Tests parts of every kind alone and in flights. A violation of an interface's rules is a fault, never an
/// exception; a call that does not return ends the process (checked_parts.hpp).
std::vector<PartCheck> check_parts(const PartCheckOptions& options);

}  // namespace understory
