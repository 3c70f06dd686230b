#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "scenarios/flight/flight_log.hpp"
#include "scenarios/report/sheet_page.hpp"

namespace understory {

/// What a page adds to a flight that has ended.
struct FlightPageExtras {
  std::filesystem::path data_root;         ///< holds models/ and scenarios/
  std::string warning = {};                ///< shown above everything else; empty: no warning
  std::filesystem::path film = {};         ///< flight.mp4; empty: none
  std::vector<float> film_times_s = {};    ///< of its pictures
  cv::Mat last_picture = {};               ///< of the film
  std::vector<SheetSection> chapter = {};  ///< behind the charts: why the flight was lost
};

/// The page of a flight: one HTML file that needs nothing else. Long flights are decimated, so that it has at
/// most 3 MB without the film; the page says what was left out. Throws MachineError where the page's program
/// or the film cannot be read.
std::string flight_page(const FlightLog& log, const FlightPageExtras& extras);

/// The same in at most 30 kB, for a campaign's page: packed_part() of the last two seconds in detail and of
/// the rest in outline.
std::string compact_flight(const FlightLog& log);

/// The arguments of `understory fly` that fly a scenario: a library's name, seed and settings, or, if those
/// do not make the same scenario, a file scenario.yaml.
std::string arguments_that_fly(const Scenario& scenario, const std::filesystem::path& data_root);

}  // namespace understory
