#pragma once

#include <filesystem>
#include <functional>

#include "scenarios/explain/evidence.hpp"
#include "scenarios/flight/flight_log.hpp"
#include "sim/render/renderer_kind.hpp"

namespace understory {

struct ExplainOptions {
  std::filesystem::path models_folder;
  /// For the flights' files; made if it is not there, and left.
  std::filesystem::path work_folder;
  RendererKind renderer = RendererKind::osmesa;
  int jobs = 1;                                             ///< flights at a time
  int first_seed = 1;                                       ///< of the redraws
  int flights = 170;                                        ///< at most so many beside the lost one
  std::function<void(std::size_t flown)> on_progress = {};  ///< may be empty
};

/// A lost flight and why it was lost.
struct ExplainedFlight {
  FlightLog log;
  ToldExplanation told;
};

/// Flies the scenario, keeps its hits, and asks with flights that go on from its moments. Throws
/// ScenarioError where it does not crash or has ideal parts already, MachineError where a flight fails,
/// Stopped at a signal.
ExplainedFlight explain_flight(const Scenario& scenario, const ExplainOptions& options);

}  // namespace understory
