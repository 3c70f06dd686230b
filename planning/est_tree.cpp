#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/control/planners/est/EST.h>

#include "planning/manoeuvre_search.hpp"

namespace understory {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;

// EST counts its nodes in the cells of a grid: place over ground and heading, in the units of the search's
// metric (squared_distance()).
class PlaceAndHeading : public ob::ProjectionEvaluator {
 public:
  using ProjectionEvaluator::ProjectionEvaluator;
  unsigned int getDimension() const override { return 3; }
  void defaultCellSizes() override { cellSizes_ = {1, 1, 0.3}; }
  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
    const FlightState& flight = flight_of(state);
    projection << flight.position_world.x(), flight.position_world.y(), flight.heading_rad;
  }
};

class SeededEst : public oc::EST {
 public:
  SeededEst(const oc::SpaceInformationPtr& space, std::uint32_t seed) : EST(space) {
    rng_.setLocalSeed(seed);
  }
};

}  // namespace

std::shared_ptr<ob::Planner> est_tree(const oc::SpaceInformationPtr& space, const ManoeuvreSearchConfig&,
                                      std::uint32_t seed) {
  const auto est = std::make_shared<SeededEst>(space, seed);
  est->setProjectionEvaluator(std::make_shared<PlaceAndHeading>(space->getStateSpace()));
  est->setRange(1);  // not used: our space draws states ahead, whatever they shall be near to
  return est;
}

}  // namespace understory
