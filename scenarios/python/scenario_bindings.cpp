#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <utility>

#include "scenarios/config/keys.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/python/bindings.hpp"
#include "scenarios/scenario/data_files.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {

void require_files(const Scenario& scenario) {
  const std::pair<const char*, std::string> brought_by[] = {
      {"perception.detector", scenario.perception.part().plugin},
      {"estimation.source", parts().state_sources.find(scenario.estimation.source)->plugin},
      {"autopilot.method", parts().planners.find(scenario.autopilot.method)->plugin},
      {"course", parts().courses.find(scenario.course)->plugin}};
  for (const auto& [key, file] : brought_by)
    if (!file.empty() &&
        std::ranges::find(scenario.plugins, file, &FileConfig::file) == scenario.plugins.end())
      throw std::runtime_error(
          fmt::format("{}: no file holds this part: put it into one and give that to load_plugin()", key));
}

void bind_scenario(py::module_& module) {
  py::class_<Scenario>(module, "Scenario")
      .def_readonly("name", &Scenario::name)
      .def_readonly("course", &Scenario::course)
      .def_readonly("seed", &Scenario::seed)
      .def_property_readonly("detector", [](const Scenario& self) { return self.perception.detector; })
      .def_property_readonly("planner", [](const Scenario& self) { return self.autopilot.method; })
      .def_property_readonly("goal_x_m", &Scenario::goal_x_m)
      .def_property_readonly("half_width_m", [](const Scenario& self) { return self.forest.half_width_m; })
      .def_property_readonly("camera_rate_hz", [](const Scenario& self) { return self.cameras.rate_hz; })
      .def_property_readonly("imu_rate_hz", [](const Scenario& self) { return self.sensors.imu_rate_hz; })
      .def_property_readonly("elevon_min_rad",
                             [](const Scenario& self) { return self.airframe.elevon_min_rad; })
      .def_property_readonly("elevon_max_rad",
                             [](const Scenario& self) { return self.airframe.elevon_max_rad; })
      .def_property_readonly("max_thrust_n", [](const Scenario& self) { return self.airframe.max_thrust_n; })
      .def_property_readonly("rig",
                             [](const Scenario& self) { return rig_of(self, data_root() / "models").rig; })
      .def("with_seed",
           [](const Scenario& self, const py::object& seed) {
             const auto number = taken<std::int64_t>(seed, "seed", "a whole number");
             if (number < 0 || static_cast<std::uint64_t>(number) > maximum_seed)
               throw ScenarioError(
                   fmt::format("seed: expected a whole number from 0 to {}, got {}", maximum_seed, number));
             Scenario other = self;
             other.seed = static_cast<std::uint64_t>(number);
             return other;
           })
      .def("with_actions",
           [](const Scenario& self, const std::string& file) {
             Scenario other = self;
             other.autopilot.actions = file;
             return other;
           })
      .def("text", &scenario_to_text)
      .def("require_files", &require_files);
  module.def(
      "load_scenario",
      [](const std::string& name, const std::vector<std::string>& settings,
         const std::vector<std::string>& with) {
        return load_scenario(scenario_file(name), settings, {with.begin(), with.end()});
      },
      py::arg("name"), py::arg("settings") = std::vector<std::string>(),
      py::arg("with_files") = std::vector<std::string>());
  module.def("keys", [] {
    py::list all;
    for (const Key& key : keys_of(Scenario())) {
      py::dict row;
      row["key"] = key.name;
      row["default"] = key.value;
      row["unit"] = key.unit;
      row["range"] = key.range;
      row["meaning"] = key.meaning;
      all.append(row);
    }
    return all;
  });
}

}  // namespace understory
