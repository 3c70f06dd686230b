#include "scenarios/cli/commands.hpp"
#include "scenarios/config_tree.hpp"

/// The commands of a build without the simulator (UNDERSTORY_SIM=OFF).
namespace understory {

int run_fly(const FlyArguments&) {
  throw ScenarioError("fly: expected a build with the simulator, this one has none (UNDERSTORY_SIM=OFF)");
}

int run_evaluate(const EvaluateArguments&) {
  throw ScenarioError(
      "evaluate: expected a build with the simulator, this one has none (UNDERSTORY_SIM=OFF)");
}

}  // namespace understory
