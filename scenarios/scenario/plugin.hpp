#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <opencv2/core/version.hpp>
#include <string>
#include <vector>

#include "estimation/filter_config.hpp"
#include "planning/manoeuvre.hpp"
#include "scenarios/parts/parts.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "understory_header_hash.hpp"

/// Plug-ins: shared libraries and Python files that add parts (docs/integrate.md, docs/python.md). A library
/// is compiled against these headers alone; the program that loads it has the functions behind them.
namespace understory {

/// What a plug-in and the program must have in common, a line each: "name: value".
inline std::string plugin_stamp() {
  const auto size = [](const char* name, std::size_t bytes, std::size_t alignment) {
    return std::string("size of ") + name + ": " + std::to_string(bytes) + " bytes, aligned to " +
           std::to_string(alignment) + "\n";
  };
  std::string stamp = "headers of understory " UNDERSTORY_HEADER_VERSION ": " UNDERSTORY_HEADER_HASH "\n";
  stamp += "OpenCV: " CVAUX_STR(CV_VERSION_MAJOR) "." CVAUX_STR(CV_VERSION_MINOR) "\n";
  stamp += "__GXX_ABI_VERSION: " + std::to_string(__GXX_ABI_VERSION) + "\n";
  stamp += "_GLIBCXX_USE_CXX11_ABI: " + std::to_string(_GLIBCXX_USE_CXX11_ABI) + "\n";
  stamp += "EIGEN_MAX_ALIGN_BYTES: " + std::to_string(EIGEN_MAX_ALIGN_BYTES) + "\n";
#ifdef NDEBUG
  stamp += "NDEBUG: defined\n";
#else
  stamp += "NDEBUG: not defined\n";
#endif
#if defined(__SANITIZE_ADDRESS__)
  stamp += "sanitizer: address\n";
#elif defined(__SANITIZE_THREAD__)
  stamp += "sanitizer: thread\n";
#else
  stamp += "sanitizer: none\n";
#endif
  stamp += size("StereoFrame", sizeof(StereoFrame), alignof(StereoFrame));
  stamp += size("State", sizeof(State), alignof(State));
  stamp += size("PlanRequest", sizeof(PlanRequest), alignof(PlanRequest));
  stamp += size("Parts", sizeof(Parts), alignof(Parts));
  stamp += size("Scenario", sizeof(Scenario), alignof(Scenario));
  return stamp;
}

/// A plug-in that has been loaded. It stays loaded until the process ends.
struct Plugin {
  std::string file;                  ///< absolute
  std::string hash;                  ///< of its contents
  std::vector<FileConfig> imported;  ///< modules beside or below a Python file that it imported
};

/// Loads the plug-in and adds its parts to parts(); one that has been loaded is not loaded again. `asked_by`
/// begins the message: "a.yaml:3: plugins". Throws ScenarioError, one line that names the file, if it is not
/// there, is not a shared library, lacks a symbol, is not a plug-in, was built for something else (what, and
/// what is needed), adds a part whose name is taken, or has changed since this process loaded it.
const Plugin& load_plugin(const std::filesystem::path& file, const std::string& asked_by);

/// Runs the text of a Python file, whose decorators add parts to `parts`. Gives the files of the modules
/// beside or below it that it imported. Throws ScenarioError, one line that names file and line.
using PythonLoader = std::vector<std::string> (*)(const std::string& file, const std::string& text,
                                                  Parts& parts);
/// Set by the Python module. Null: Python is not loaded yet; the first plug-in that ends in .py loads it.
PythonLoader& python_loader();

/// The files of --plugin, which every scenario that is read then loads.
std::vector<std::string>& given_plugins();

}  // namespace understory

/// Begins the function that adds a plug-in's parts:
///   UNDERSTORY_PLUGIN(parts) { parts.detectors.add({.name = "mine", ...}); }
#define UNDERSTORY_PLUGIN(parts)                                                            \
  extern "C" __attribute__((visibility("default"))) const char* understory_plugin_stamp() { \
    static const std::string stamp = understory::plugin_stamp();                            \
    return stamp.c_str();                                                                   \
  }                                                                                         \
  extern "C" __attribute__((visibility("default"))) void understory_plugin_add(understory::Parts& parts)
