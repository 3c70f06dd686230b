#include "scenarios/output/errors.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/python/bindings.hpp"

PYBIND11_MODULE(_understory, module) {
  using namespace understory;
  module.attr("__version__") = understory_version;
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<MachineError>(module, "MachineError", PyExc_RuntimeError);
  bind_types(module);
  bind_parts(module);
  bind_flight(module);
}
