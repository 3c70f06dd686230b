#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {

namespace fs = std::filesystem;

fs::path project_root() {
  const auto is_root = [](const fs::path& folder) {
    std::error_code ignored;
    return fs::is_directory(folder / "models", ignored) && fs::is_directory(folder / "scenarios", ignored);
  };
  if (const char* given = std::getenv("UNDERSTORY_ROOT")) {
    if (is_root(given)) return given;
    throw ScenarioError(
        fmt::format("UNDERSTORY_ROOT={}: expected a folder with models/ and scenarios/", given));
  }
  if (is_root(UNDERSTORY_SOURCE_DIR)) return UNDERSTORY_SOURCE_DIR;
  std::error_code ignored;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
       folder.has_relative_path(); folder = folder.parent_path()) {
    if (is_root(folder)) return folder;
  }
  throw MachineError("models/ is missing: set UNDERSTORY_ROOT to the source tree");
}

fs::path scenario_file(const std::string& argument) {
  std::error_code ignored;
  const bool is_folder =
      fs::is_directory(argument, ignored);  // may be called as a scenario of the library is
  if (!is_folder && fs::exists(argument, ignored)) return argument;
  const fs::path in_root =
      project_root() / argument;  // scenarios/library/forest.yaml, from any working directory
  if (fs::is_regular_file(in_root, ignored)) return in_root;
  const fs::path library = project_root() / "scenarios" / "library";
  const bool is_name = argument.find('/') == std::string::npos && !argument.ends_with(".yaml");
  const fs::path named = library / (argument + ".yaml");
  if (is_name && fs::exists(named, ignored)) return named;
  if (is_folder) throw ScenarioError(fmt::format("{}: expected a scenario file, this is a folder", argument));
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(library, ignored))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  throw ScenarioError(fmt::format("{}: expected a scenario file, or one of the library: {}", argument,
                                  fmt::join(names, ", ")));
}

}  // namespace understory
