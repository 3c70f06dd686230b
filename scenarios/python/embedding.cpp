#include <Python.h>
#include <dlfcn.h>

#include <filesystem>
#include <string>

#include "scenarios/output/errors.hpp"
#include "scenarios/python/bindings.hpp"

extern "C" PyObject* PyInit__understory();

namespace understory {
namespace {

namespace fs = std::filesystem;

/// The folder of the package `understory`: beside this module in a build folder, else where it was installed.
std::string package_folder() {
  Dl_info info{};
  std::error_code ignored;
  dladdr(reinterpret_cast<const void*>(&package_folder), &info);
  const fs::path here = fs::canonical(info.dli_fname, ignored).parent_path();
  for (const fs::path& folder : {here / "python", here / UNDERSTORY_PYTHON_PACKAGES})
    if (fs::exists(folder / "understory/__init__.py", ignored)) return fs::canonical(folder).string();
  throw MachineError(
      "plug-ins in Python need the package python3-understory: found no understory/__init__.py");
}

void start() {
  PyImport_AppendInittab("_understory", PyInit__understory);
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  config.install_signal_handlers = 0;  // the program has its own
  config.parse_argv = 0;
  PyStatus status = PyConfig_SetBytesString(&config, &config.program_name, UNDERSTORY_PYTHON_PROGRAM);
  if (!PyStatus_Exception(status)) status = Py_InitializeFromConfig(&config);
  PyConfig_Clear(&config);
  if (PyStatus_Exception(status))
    throw MachineError(std::string("Python does not start: ") +
                       (status.err_msg != nullptr ? status.err_msg : "no reason given"));
  try {
    py::module_::import("sys").attr("path").attr("insert")(0, package_folder());
    py::module_::import("understory").attr("_outlive_parts")();
  } catch (py::error_already_set& error) {
    throw MachineError(std::string("plug-ins in Python: ") + error.what());
  }
  PyEval_SaveThread();  // each call takes the lock for itself
}

}  // namespace
}  // namespace understory

/// Called once by the program, before its first plug-in in Python.
extern "C" __attribute__((visibility("default"))) void understory_start_python() { understory::start(); }
