#include "scenarios/output/errors.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/python/bindings.hpp"

PYBIND11_MODULE(_understory, module) {
  using namespace understory;
  understory_commit = commit_of_this_build;
  module.attr("__version__") = understory_version;
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<MachineError>(module, "MachineError", PyExc_RuntimeError);
  // Asked first: Ctrl-C in a part is the keyboard's, whatever the call that failed by it was told as.
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      std::rethrow_exception(error);
    } catch (const std::runtime_error&) {
      if (!was_interrupted()) throw;
      PyErr_SetNone(PyExc_KeyboardInterrupt);
    }
  });
  bind_types(module);
  bind_parts(module);
  bind_scenario(module);
  bind_flight(module);
}
