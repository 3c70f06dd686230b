#include "planning/manoeuvre_search.hpp"

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalRegion.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/control/SpaceInformation.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace understory {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;

constexpr int maximum_parts = 6;

// A node of the tree: the predicted aircraft and the commands that lead there.
struct Node {
  FlightState flight;
  double cost = 0;
  bool free = true;
  int part_count = 0;
  std::array<ManoeuvrePart, maximum_parts> parts{};
};

class NodeState : public ob::State {
 public:
  Node node;
};

const Node& node_of(const ob::State* state) { return static_cast<const NodeState*>(state)->node; }
Node& node_of(ob::State* state) { return static_cast<NodeState*>(state)->node; }

// Draws states for a tree to grow towards: anywhere in the corridor ahead, in any attitude.
class CorridorSampler : public ob::StateSampler {
 public:
  CorridorSampler(const ob::StateSpace* space, const FlightTask& task, const FlightState& start,
                  std::uint32_t seed)
      : StateSampler(space), task_(task), start_(start) {
    rng_.setLocalSeed(seed);
  }

  void sampleUniform(ob::State* state) override {
    Node& node = node_of(state);
    const double ahead_m = rng_.uniformReal(0.5, task_.config.horizon_m);
    const double aside_m = rng_.uniformReal(-0.4, 0.4) * ahead_m;
    const double heading = task_.mission.heading_rad;
    node.flight = start_;
    node.flight.position_world += Eigen::Vector3d(std::cos(heading) * ahead_m - std::sin(heading) * aside_m,
                                                  std::sin(heading) * ahead_m + std::cos(heading) * aside_m,
                                                  rng_.uniformReal(-0.7, 0.7));
    node.flight.heading_rad = heading + rng_.uniformReal(-0.7, 0.7);
    node.flight.bank_rad = rng_.uniformReal(-1.3, 1.3);
  }
  void sampleUniformNear(ob::State* state, const ob::State*, double) override { sampleUniform(state); }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
  const FlightTask& task_;
  const FlightState& start_;
};

// The space of flight states.
class FlightStateSpace : public ob::StateSpace {
 public:
  FlightStateSpace(const FlightTask& task, const FlightState& start, std::uint32_t seed)
      : task_(task), start_(start), seed_(seed) {
    setName("flight");
  }

  double distance(const ob::State* a, const ob::State* b) const override {
    return std::sqrt(squared_distance(place_of(node_of(a).flight), place_of(node_of(b).flight)));
  }
  ob::StateSamplerPtr allocDefaultStateSampler() const override {
    return std::make_shared<CorridorSampler>(this, task_, start_, seed_);
  }
  ob::State* allocState() const override { return new NodeState; }
  void freeState(ob::State* state) const override { delete static_cast<NodeState*>(state); }
  void copyState(ob::State* destination, const ob::State* source) const override {
    node_of(destination) = node_of(source);
  }
  unsigned int getDimension() const override { return 11; }
  double getMaximumExtent() const override { return 100; }
  double getMeasure() const override { return 1; }
  void enforceBounds(ob::State*) const override {}
  bool satisfiesBounds(const ob::State*) const override { return true; }
  bool equalStates(const ob::State* a, const ob::State* b) const override { return distance(a, b) == 0; }
  void interpolate(const ob::State* from, const ob::State*, double, ob::State* state) const override {
    copyState(state, from);  // never asked for by a control planner
  }

 private:
  const FlightTask& task_;
  const FlightState& start_;
  std::uint32_t seed_;
};

class CommandSampler : public oc::ControlSampler {
 public:
  CommandSampler(const oc::ControlSpace* space, const ManoeuvreSearchConfig& config, const Manoeuvre& hint,
                 std::uint32_t seed)
      : ControlSampler(space), config_(config), hint_(hint) {
    rng_.setLocalSeed(seed);
  }
  void sample(oc::Control* control) override {
    double* values = control->as<oc::RealVectorControlSpace::ControlType>()->values;
    values[0] = rng_.uniformReal(-config_.maximum_bank_rad, config_.maximum_bank_rad);
    values[1] = rng_.uniformReal(config_.minimum_climb_mps, config_.maximum_climb_mps);
    const double lot = rng_.uniform01();
    if (lot < config_.hint_share && !hint_.empty()) {
      const FlightCommand& near = hint_[rng_.uniformInt(0, static_cast<int>(hint_.size()) - 1)].command;
      values[0] = std::clamp(near.bank_rad + rng_.gaussian(0, 0.15), -config_.maximum_bank_rad,
                             config_.maximum_bank_rad);
      values[1] = near.climb_mps;
    } else if (lot > 1 - config_.extreme_share) {
      values[0] = std::copysign(config_.maximum_bank_rad, values[0]);
    }
  }

 private:
  const ManoeuvreSearchConfig& config_;
  const Manoeuvre& hint_;
};

// A node holds its whole cost so far, clearance included. OMPL adds up the differences.
class AccumulatedCost : public ob::OptimizationObjective {
 public:
  using OptimizationObjective::OptimizationObjective;
  ob::Cost stateCost(const ob::State*) const override { return ob::Cost(0); }
  ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
    return ob::Cost(node_of(to).cost - node_of(from).cost);
  }
};

// The goal: states from which the course guidance alone reaches the horizon. It remembers the cheapest whole
// flight (the commands so far and the course guidance to the horizon), and reports no state as reached:
// OMPL's planners account only for the tree, and RRT and EST would end at their first answer.
class FreeCourse : public ob::Goal {
 public:
  FreeCourse(const ob::SpaceInformationPtr& space, const FlightTask& task, double maximum_cost)
      : Goal(space), best_cost(maximum_cost), task_(task) {}
  bool isSatisfied(const ob::State* state) const override { return isSatisfied(state, nullptr); }
  bool isSatisfied(const ob::State* state, double* distance) const override {
    const Node& node = node_of(state);
    const double to_go_m = task_.config.horizon_m - progress_m(task_, node.flight.position_world);
    if (distance != nullptr) *distance = std::max(0.0, to_go_m);
    if (is_too_dear(node)) return false;
    // A flight that cannot become the cheapest is not flown to its end. The limit is
    // slightly larger than what remains, so that rounding decides nothing.
    const double to_spend = (best_cost - node.cost) * (1 + 1e-9) + 1e-9;
    const Rollout rest =
        fly_out(task_, node.flight, {}, task_.config.minimum_clearance_m, false, true, to_spend);
    if (rest.reached_horizon && node.cost + rest.cost < best_cost) {
      best_cost = node.cost + rest.cost;
      best.emplace(node.parts.begin(), node.parts.begin() + node.part_count);
    }
    return false;
  }

  /// Whether no flight through this node costs less than the best answer.
  bool is_too_dear(const Node& node) const {
    return node.cost + least_cost_to_go(task_, node.flight) >= best_cost;
  }

  mutable double best_cost;
  mutable std::optional<Manoeuvre> best;

 private:
  const FlightTask& task_;
};

void propagate(const FlightTask& task, const ManoeuvreSearchConfig& config, const Node& from,
               const FlightCommand& command, double step_s, Node& to) {
  to = from;
  const bool continues = to.part_count > 0 && to.parts[to.part_count - 1].command == command;
  if (!continues && to.part_count == config.maximum_parts) {
    to.free = false;
    return;
  }
  if (!continues) to.parts[to.part_count++] = {command, 0};
  to.parts[to.part_count - 1].duration_s += step_s;
  to.flight = task.model.advance(from.flight, command, step_s);
  if (task.steps != nullptr) ++*task.steps;
  const double clearance =
      task.field.clearance_m(to.flight, maximum_clearance_m(task.config, task.config.minimum_clearance_m));
  to.cost += step_s * cost_rate(task, to.flight, clearance);
  to.free = std::min(clearance, band_clearance_m(task, to.flight)) >= task.config.minimum_clearance_m &&
            progress_m(task, to.flight.position_world) < task.config.horizon_m;
}

}  // namespace

const FlightState& flight_of(const ob::State* state) { return node_of(state).flight; }

std::optional<Manoeuvre> search_manoeuvre(const FlightTask& task, const FlightState& start,
                                          const Manoeuvre& hint, const ManoeuvreSearchConfig& config,
                                          double maximum_cost, std::uint64_t seed, TreeMaker tree) {
  ompl::msg::noOutputHandler();
  const auto seed_of = [seed](std::uint32_t part) {  // OMPL's seeds are 32 bits wide and not zero
    return static_cast<std::uint32_t>((seed ^ (seed >> 32)) * 4 + part) | 1u << 31;
  };
  const auto states = std::make_shared<FlightStateSpace>(task, start, seed_of(0));
  const auto controls = std::make_shared<oc::RealVectorControlSpace>(states, 2);
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, -config.maximum_bank_rad), bounds.setHigh(0, config.maximum_bank_rad);
  bounds.setLow(1, config.minimum_climb_mps), bounds.setHigh(1, config.maximum_climb_mps);
  controls->setBounds(bounds);
  controls->setControlSamplerAllocator([&](const oc::ControlSpace* space) {
    return std::make_shared<CommandSampler>(space, config, hint, seed_of(1));
  });

  const auto space = std::make_shared<oc::SpaceInformation>(states, controls);
  const auto goal = std::make_shared<FreeCourse>(space, task, maximum_cost);
  space->setStateValidityChecker(
      [&](const ob::State* state) { return node_of(state).free && !goal->is_too_dear(node_of(state)); });
  space->setStatePropagator(
      [&](const ob::State* from, const oc::Control* control, double step_s, ob::State* to) {
        const double* values = control->as<oc::RealVectorControlSpace::ControlType>()->values;
        propagate(task, config, node_of(from), {values[0], values[1]}, step_s, node_of(to));
      });
  const double step_s = task.config.step_s;
  space->setPropagationStepSize(step_s);
  space->setMinMaxControlDuration(static_cast<unsigned>(std::lround(config.minimum_part_s / step_s)),
                                  static_cast<unsigned>(std::lround(config.maximum_part_s / step_s)));
  space->setup();

  const auto problem = std::make_shared<ob::ProblemDefinition>(space);
  ob::ScopedState<> start_state(states);
  node_of(start_state.get()).flight = start;
  problem->addStartState(start_state);
  problem->setGoal(goal);
  problem->setOptimizationObjective(std::make_shared<AccumulatedCost>(space));

  const std::shared_ptr<ob::Planner> planner = tree(space, config, seed_of(2));
  planner->setProblemDefinition(problem);
  int asked = 0;
  planner->solve(ob::PlannerTerminationCondition([&] { return ++asked > config.iterations; }));
  return goal->best;
}

}  // namespace understory
