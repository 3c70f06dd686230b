#include "tests/validation/aircraft_page.hpp"

#include "planning/airframe.hpp"
#include "tests/validation/dodge_section.hpp"
#include "tests/validation/fluid_section.hpp"
#include "tests/validation/glide_section.hpp"
#include "tests/validation/modes_section.hpp"
#include "tests/validation/replay_section.hpp"
#include "tests/validation/roll_section.hpp"
#include "tests/validation/tracking_section.hpp"
#include "tests/validation/trim_section.hpp"
#include "tests/validation/turn_section.hpp"

namespace understory {

ValidationPage aircraft_page(const std::filesystem::path& root) {
  const Airframe airframe;
  const FreeFlight air(root / "models", airframe);
  const FlightRecord record = read_flight_record(root / "tests" / "data" / "flight" / "left_jog.csv");
  ValidationPage page;
  page.file = "flight_model";
  page.title = "The flight model";
  page.introduction =
      "The simulated delta wing (`sim/aircraft/aerodynamics`, `sim/aircraft/aircraft`) beside what is known "
      "of the real one. "
      "`./run validate` writes this page and its figures, and ends with status 1 where one "
      "of its tolerances is broken. FACTS: the figures that the project was given, from the flight records "
      "of the original aircraft (2014 to 2017) or computed from its identified model.\n";
  page.sections = {trim_section(airframe),
                   modes_section(airframe),
                   turn_section(airframe),
                   glide_section(airframe),
                   roll_section(air, airframe),
                   dodge_section(air, airframe),
                   replay_section(air, airframe, record),
                   tracking_section(air, airframe, record),
                   fluid_section(airframe)};
  return page;
}

}  // namespace understory
