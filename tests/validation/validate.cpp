#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "tests/validation/sections.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

std::vector<Section> aircraft_sections() {
  const Airframe airframe;
  const FreeFlight air(airframe);
  const FlightRecord record = real_left_jog();
  return {trim_section(airframe),
          modes_section(airframe),
          turn_section(airframe),
          glide_section(airframe),
          roll_section(air, airframe),
          dodge_section(air, airframe),
          replay_section(air, airframe, record),
          tracking_section(air, airframe, record),
          fluid_section(airframe)};
}

std::vector<Section> estimator_sections() {
  constexpr int flights = 100;
  std::vector<Section> sections{calm_consistency_section(flights), turbulent_consistency_section(flights)};
  for (Section& section : graded_consistency_sections(flights)) sections.push_back(std::move(section));
  sections.push_back(drift_section(flights));
  return sections;
}

struct Page {
  std::string name;  ///< docs/NAME.md, its pictures in docs/NAME
  std::vector<Section> (*sections)();
};

const std::vector<Page> pages{{"flight_model", aircraft_sections},
                              {"estimator", estimator_sections},
                              {"model_mismatch", mismatch_sections},
                              {"limits",
                               [] {
                                 return std::vector<Section>{limits_section(), requirements_section()};
                               }},
                              {"ci", [] { return std::vector<Section>{gate_section()}; }}};

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Writes the file, or with --check says whether it agrees. How many faults that is.
int deliver(const fs::path& file, const std::string& content, bool check) {
  if (!check) write_whole_file(file, content);
  if (!check || agree(read_text(file), content)) return 0;
  fmt::print("broken  {}: not what is measured; make it again: ./run validate\n", file.string());
  return 1;
}

/// How many tolerances are broken, and with --check files that say something else.
int validate(const Page& page, bool check) {
  const fs::path docs = UNDERSTORY_SOURCE_DIR "/docs", file = docs / (page.name + ".md");
  const std::vector<Section> sections = page.sections();
  int faults = 0;
  for (const Section& section : sections) {
    fmt::print("{}", lines_of(section.checks));
    for (const Check& tolerance : section.checks) faults += tolerance.holds ? 0 : 1;
    for (const auto& [name, svg] : section.pictures)
      faults += deliver(docs / page.name / (name + ".svg"), svg, check);
  }
  try {
    faults += deliver(file, filled(read_text(file), sections), check);
  } catch (const ScenarioError& error) {
    throw ScenarioError(fmt::format("{}: {}", file.string(), error.what()));
  }
  std::fflush(stdout);
  return faults;
}

int run(const std::vector<std::string>& arguments) {
  std::vector<Page> chosen;
  bool check = false;
  for (const std::string& argument : arguments) {
    const auto page =
        std::find_if(pages.begin(), pages.end(), [&](const Page& p) { return p.name == argument; });
    if (argument == "--check")
      check = true;
    else if (page != pages.end())
      chosen.push_back(*page);
    else
      throw ScenarioError(argument +
                          ": expected --check, flight_model, estimator, model_mismatch, limits or ci");
  }
  int faults = 0;
  for (const Page& page : chosen.empty() ? pages : chosen) faults += validate(page, check);
  if (faults > 0) fmt::print("{} broken\n", faults);
  return faults > 0 ? 1 : 0;
}

}  // namespace
}  // namespace understory

/// understory_validate [--check] [PAGE ...]: measures, and fills the pages of docs/ and their pictures; with
/// --check it writes nothing. Exit status: 0; 1 where a tolerance is broken or, with --check, a page says
/// something else; 2 for a wrong argument or a page without its blocks; 3 where the machine failed.
int main(int argc, char** argv) {
  try {
    return understory::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "understory_validate: {}\n", error.what());
    return dynamic_cast<const understory::ScenarioError*>(&error) != nullptr ? 2 : 3;
  }
}
