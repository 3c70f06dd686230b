#include <ompl/control/planners/sst/SST.h>
#include <ompl/datastructures/NearestNeighbors.h>
#include <ompl/util/Exception.h>

#include <algorithm>

#include "planning/manoeuvre_search.hpp"

namespace understory {
namespace {

namespace oc = ompl::control;

// SST's motions by their places. OMPL's own structures call a function pointer for each distance.
template <typename Motion>
class NearestMotions : public ompl::NearestNeighbors<Motion> {
 public:
  bool reportsSortedResults() const override { return true; }
  void clear() override { motions_.clear(), places_.clear(); }
  void add(const Motion& motion) override {
    motions_.push_back(motion);
    places_.add(place(motion));
  }
  bool remove(const Motion& motion) override {
    const auto last = std::find(motions_.rbegin(), motions_.rend(), motion);
    if (last == motions_.rend()) return false;
    places_.remove(static_cast<std::size_t>(motions_.rend() - last - 1));
    motions_.erase(std::next(last).base());
    return true;
  }
  Motion nearest(const Motion& motion) const override {
    if (motions_.empty()) throw ompl::Exception("no motions to be near to");
    return motions_[places_.nearest(place(motion))];
  }
  void nearestK(const Motion& motion, std::size_t k, std::vector<Motion>& nearest) const override {
    give(places_.nearest(place(motion), k), nearest);
  }
  void nearestR(const Motion& motion, double radius, std::vector<Motion>& nearest) const override {
    give(places_.within(place(motion), radius), nearest);
  }
  std::size_t size() const override { return motions_.size(); }
  void list(std::vector<Motion>& motions) const override { motions = motions_; }

 private:
  static FlightPlace place(const Motion& motion) { return place_of(flight_of(motion->state_)); }
  void give(const std::vector<std::size_t>& numbers, std::vector<Motion>& motions) const {
    motions.clear();
    for (const std::size_t number : numbers) motions.push_back(motions_[number]);
  }

  std::vector<Motion> motions_;
  FlightPlaces places_;
};

class SeededSst : public oc::SST {
 public:
  SeededSst(const oc::SpaceInformationPtr& space, std::uint32_t seed) : SST(space) {
    rng_.setLocalSeed(seed);
    // SST's own way to choose these needs the problem, which is not there yet.
    nn_ = std::make_shared<NearestMotions<Motion*>>();
    witnesses_ = std::make_shared<NearestMotions<Motion*>>();
  }
  // OMPL 1.5.2 deletes the witnesses and leaves their states and controls: 7 kB a search.
  ~SeededSst() override {
    std::vector<Motion*> witnesses;
    witnesses_->list(witnesses);
    for (Motion* witness : witnesses) {
      si_->freeState(witness->state_);
      siC_->freeControl(witness->control_);
    }
  }
};

}  // namespace

std::shared_ptr<ompl::base::Planner> sst_tree(const oc::SpaceInformationPtr& space,
                                              const ManoeuvreSearchConfig& config, std::uint32_t seed) {
  const auto sst = std::make_shared<SeededSst>(space, seed);
  sst->setSelectionRadius(config.selection_radius);
  sst->setPruningRadius(config.pruning_radius);
  return sst;
}

}  // namespace understory
