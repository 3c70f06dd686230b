#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "planning/manoeuvre.hpp"

namespace ompl::base {
class Planner;
class State;
}  // namespace ompl::base
namespace ompl::control {
class SpaceInformation;
}

namespace understory {

/// Makes an OMPL planner for the space of flight states and commands, all of whose random generators are
/// seeded with `seed`. OMPL has one generator per process, and with that one a replan would depend on all
/// replans before it.
using TreeMaker =
    std::shared_ptr<ompl::base::Planner> (*)(const std::shared_ptr<ompl::control::SpaceInformation>& space,
                                             const ManoeuvreSearchConfig& config, std::uint32_t seed);

/// The cheapest manoeuvre found whose rollout reaches the horizon without touching an obstacle and costs less
/// than `maximum_cost`, or nothing. Some commands are drawn near those of `hint`, the plan in force (may be
/// empty). Repeats exactly for equal arguments, independent of earlier searches: `seed` seeds every generator
/// of the search.
std::optional<Manoeuvre> search_manoeuvre(const FlightTask& task, const FlightState& start,
                                          const Manoeuvre& hint, const ManoeuvreSearchConfig& config,
                                          double maximum_cost, std::uint64_t seed, TreeMaker tree);

/// The predicted aircraft at a node of the tree.
const FlightState& flight_of(const ompl::base::State* state);

/// SST (Li, Littlefield & Bekris 2016) grows low-cost paths.
std::shared_ptr<ompl::base::Planner> sst_tree(const std::shared_ptr<ompl::control::SpaceInformation>& space,
                                              const ManoeuvreSearchConfig& config, std::uint32_t seed);
/// RRT (LaValle & Kuffner 2001) grows from the node nearest to a random state, whatever its cost.
std::shared_ptr<ompl::base::Planner> rrt_tree(const std::shared_ptr<ompl::control::SpaceInformation>& space,
                                              const ManoeuvreSearchConfig& config, std::uint32_t seed);
/// EST (Hsu, Latombe & Motwani 1999) grows from regions with few nodes.
std::shared_ptr<ompl::base::Planner> est_tree(const std::shared_ptr<ompl::control::SpaceInformation>& space,
                                              const ManoeuvreSearchConfig& config, std::uint32_t seed);

}  // namespace understory
