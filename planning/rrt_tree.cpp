#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>

#include "planning/manoeuvre_search.hpp"

namespace understory {
namespace {

namespace oc = ompl::control;

class SeededRrt : public oc::RRT {
 public:
  SeededRrt(const oc::SpaceInformationPtr& space, std::uint32_t seed) : RRT(space) {
    rng_.setLocalSeed(seed);
    nn_ = std::make_shared<ompl::NearestNeighborsLinear<Motion*>>();  // the others own a generator
  }
};

}  // namespace

std::shared_ptr<ompl::base::Planner> rrt_tree(const oc::SpaceInformationPtr& space,
                                              const ManoeuvreSearchConfig&, std::uint32_t seed) {
  return std::make_shared<SeededRrt>(space, seed);
}

}  // namespace understory
