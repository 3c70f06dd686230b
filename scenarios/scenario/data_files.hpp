#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Where the files of models/ and scenarios/ are, and what their names mean.
namespace understory {

/// The path a rig argument means: one that exists, or a name in models/rigs. Throws ScenarioError, naming
/// what there is, where it means none.
std::filesystem::path rig_path(const std::string& argument);
/// The file that a scenario argument means: one that exists, or a name in scenarios/library. Throws
/// ScenarioError, naming what there is, where it means none.
std::filesystem::path scenario_file(const std::string& argument);
/// The same of a file in another folder of scenarios/: library_file("gate", "campaigns", "campaign").
std::filesystem::path library_file(const std::string& argument, const char* folder, const char* noun);
/// The names of all rigs, and of all scenarios.
std::vector<std::string> rig_names();
std::vector<std::string> scenario_names();

/// The folder with models/ and scenarios/: $UNDERSTORY_ROOT; else share/understory below a folder above the
/// program (or the Python module), as it is installed and packaged; else the folder above it that has them,
/// as in a source tree. Throws MachineError where there is none.
std::filesystem::path data_root();

}  // namespace understory
