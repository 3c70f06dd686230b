#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/flight/flight_result.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/report/sheet_page.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/render/renderer_kind.hpp"

namespace understory {

class FlightLogger;
class FlightObserver;

/// Where a flight is, for a progress line.
struct FlightProgress {
  double simulated_s = 0;
  double wall_s = 0;
  double progress_m = 0;
  double goal_m = 0;
  double speed_mps = 0;
  double minimum_clearance_m = 0;
};

struct FlyOptions {
  std::filesystem::path models_folder;
  std::filesystem::path output_folder;           ///< gets the run's files (OutputFolder); empty: no files
  bool video = false;                            ///< also flight.mp4 and still.png
  bool report = false;                           ///< also report.html, with the film where there is one
  std::filesystem::path track;                   ///< compact_flight() of a lost flight; empty: none
  std::vector<SheetSection> chapter;             ///< of report.html, behind its charts
  std::string expected_digest;                   ///< another one is a warning in the report; empty: any
  RendererKind renderer = RendererKind::osmesa;  ///< the machine's: not part of the scenario
  FlightLogger* logger = nullptr;                ///< keeps the log for other observers; null: not needed
  std::vector<FlightObserver*> observers;        ///< beside the logger
  std::function<void(const FlightProgress&)> on_progress;  ///< ten times per simulated second; may be empty
};

/// A film could not be finished; the run's other files are whole.
struct LostFilm : MachineError {
  using MachineError::MachineError;
};

/// The warning of a page if its flight is not the run's; empty if it is the same or this is unknown.
std::string warning_of_digest(const FlightResult& result, const std::string& expected_digest);

/// Flies a scenario once and leaves its files (run_files.hpp). Throws
/// ScenarioError at bad input (rig, folder), MachineError where the machine fails (GL library, disk),
/// LostFilm where only the film does.
FlightResult fly(const Scenario& scenario, const FlyOptions& options);

}  // namespace understory
