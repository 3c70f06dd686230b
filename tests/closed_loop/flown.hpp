#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace understory {

inline const std::filesystem::path root = UNDERSTORY_SOURCE_DIR;

/// What a flight of the program left behind.
struct Flown {
  nlohmann::json result;
  std::string trajectory;  ///< the whole csv

  std::string outcome() const { return result.at("outcome"); }
  double minimum_clearance_m() const { return result.at("minimum_clearance_m"); }
  long detections() const { return result.at("detections"); }
  long remembered_points() const { return result.at("remembered_points"); }
  std::string digest() const { return result.at("digest"); }
};

/// Flies a library scenario in a process of its own (one process flies one flight: OMPL's generator is
/// global) and reads its run folder. `settings` are "key=value", `options` are added as they are.
inline Flown flown(const std::string& scenario, int seed, const std::vector<std::string>& settings = {},
                   const std::string& options = "") {
  static int count = 0;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() /
      ("understory_test_" + std::to_string(getpid()) + "_" + std::to_string(count++));
  std::string command = std::string("'") + UNDERSTORY_BINARY + "' fly '" + UNDERSTORY_SOURCE_DIR +
                        "/scenarios/library/" + scenario + ".yaml' --quiet --seed " + std::to_string(seed) +
                        " --out '" + folder.string() + "' " + options;
  for (const std::string& setting : settings) command += " --set '" + setting + "'";
  const int status = std::system(command.c_str());
  Flown flight;
  if (std::ifstream file(folder / "result.json"); file) flight.result = nlohmann::json::parse(file);
  std::stringstream text;
  text << std::ifstream(folder / "trajectory.csv").rdbuf();
  flight.trajectory = text.str();
  std::filesystem::remove_all(folder);
  if (flight.result.is_null()) {
    throw std::runtime_error("no result, status " + std::to_string(status) + ": " + command);
  }
  return flight;
}

/// `settings` and more.
inline std::vector<std::string> with(std::vector<std::string> settings,
                                     const std::vector<std::string>& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

/// The columns of a trajectory whose names are given, row by row.
inline std::vector<std::vector<double>> columns(const Flown& flight, const std::vector<std::string>& names) {
  std::stringstream text(flight.trajectory);
  std::string line, word;
  std::getline(text, line);
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    std::stringstream header(line);
    for (std::size_t place = 0; std::getline(header, word, ','); ++place)
      if (word == name) places.push_back(place);
  }
  std::vector<std::vector<double>> rows;
  while (std::getline(text, line)) {
    std::vector<double> all, chosen;
    std::stringstream cells(line);
    while (std::getline(cells, word, ',')) all.push_back(std::stod(word));
    for (const std::size_t place : places) chosen.push_back(all.at(place));
    rows.push_back(std::move(chosen));
  }
  return rows;
}

}  // namespace understory
