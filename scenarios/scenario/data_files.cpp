#include "scenarios/scenario/data_files.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/errors.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

bool has_data(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "models", ignored) && fs::is_directory(folder / "scenarios", ignored);
}

std::vector<std::string> yaml_names(const fs::path& folder) {
  std::error_code ignored;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The Python module, where this is part of it, else the program.
fs::path own_file() {
  std::error_code ignored;
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&data_root), &info) != 0 && info.dli_fname != nullptr &&
      std::string_view(info.dli_fname).ends_with(".so"))
    return fs::canonical(info.dli_fname, ignored);
  return fs::read_symlink("/proc/self/exe", ignored);
}

}  // namespace

fs::path data_root() {
  if (const char* given = std::getenv("UNDERSTORY_ROOT")) {
    if (has_data(given)) return given;
    throw ScenarioError(
        fmt::format("UNDERSTORY_ROOT={}: must be a folder with models/ and scenarios/", given));
  }
  for (fs::path folder = own_file(); folder.has_relative_path();) {
    folder = folder.parent_path();
    if (has_data(folder / "share/understory")) return folder / "share/understory";
    if (has_data(folder)) return folder;
  }
  throw MachineError(
      "models/ and scenarios/ are missing: install them, or set UNDERSTORY_ROOT to their folder");
}

fs::path library_file(const std::string& argument, const char* folder, const char* noun) {
  std::error_code ignored;
  const bool is_folder = fs::is_directory(argument, ignored);  // may be called as a file of the library is
  if (!is_folder && fs::exists(argument, ignored)) return argument;
  const fs::path in_root = data_root() / argument;  // scenarios/library/forest.yaml, from any folder
  if (fs::is_regular_file(in_root, ignored)) return in_root;
  const bool is_name = argument.find('/') == std::string::npos && !argument.ends_with(".yaml");
  const fs::path library = data_root() / "scenarios/library" / folder, named = library / (argument + ".yaml");
  if (is_name && fs::exists(named, ignored)) return named;
  if (is_folder) throw ScenarioError(fmt::format("{}: must be a {} file, is a folder", argument, noun));
  if (!is_name) throw ScenarioError(fmt::format("{}: cannot read this {} file", argument, noun));
  const std::vector<std::string> names = yaml_names(library);
  const bool is_scenario = fs::exists(data_root() / "scenarios/library" / (argument + ".yaml"), ignored);
  throw ScenarioError(fmt::format("{}: {} {} file, and none in the library, which has: {}{}", argument,
                                  is_scenario ? "is a scenario, no" : "no such", noun, fmt::join(names, ", "),
                                  did_you_mean(argument, names)));
}

std::vector<std::string> scenario_names() { return yaml_names(data_root() / "scenarios/library"); }

fs::path scenario_file(const std::string& argument) { return library_file(argument, "", "scenario"); }

std::vector<std::string> rig_names() { return yaml_names(data_root() / "models" / "rigs"); }

fs::path rig_path(const std::string& argument) {
  std::error_code ignored;
  if (fs::exists(argument, ignored)) return argument;
  const bool is_name = argument.find_first_of("/.") == std::string::npos;
  const fs::path named = data_root() / "models" / "rigs" / (argument + ".yaml");
  if (is_name && fs::exists(named, ignored)) return named;
  throw ScenarioError(fmt::format("{}: no such rig file or calibration; rigs of the library: {}", argument,
                                  fmt::join(rig_names(), ", ")));
}

}  // namespace understory
