#pragma once

#include <ompl/base/State.h>
#include <ompl/datastructures/NearestNeighbors.h>
#include <ompl/util/Exception.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "planning/flight_model.hpp"

namespace understory {

/// Where a flight state lies in the search's space. Units are chosen so that one unit of each matters about
/// equally over the horizon: 1 m, 0.3 rad of heading, 0.8 rad of bank.
struct FlightPlace {
  Eigen::Vector3d position_world;
  double heading_rad, bank_rad;
};

inline FlightPlace place_of(const FlightState& state) {
  return {state.position_world, state.heading_rad, state.bank_rad};
}

inline double squared_distance(const FlightPlace& one, const FlightPlace& other) {
  const double heading = (one.heading_rad - other.heading_rad) / 0.3;
  const double bank = (one.bank_rad - other.bank_rad) / 0.8;
  return (one.position_world - other.position_world).squaredNorm() + heading * heading + bank * bank;
}

/// The flight state in a state of the search's space (manoeuvre_search.cpp).
const FlightState& flight_state_of(const ompl::base::State* state);

/// What ompl::NearestNeighborsLinear answers, in the same order, sooner: places lie side by side and no
/// distance is asked for twice or through pointers to functions. `Motion` points to something with a `state_`
/// that flight_state_of() reads and that does not change while it is in here. Owns no generator of random
/// numbers.
template <typename Motion>
class NearestFlightStates : public ompl::NearestNeighbors<Motion> {
 public:
  bool reportsSortedResults() const override { return true; }
  void clear() override { motions_.clear(), places_.clear(); }
  void add(const Motion& motion) override {
    motions_.push_back(motion);
    places_.push_back(place_of(flight_state_of(motion->state_)));
  }
  bool remove(const Motion& motion) override {
    const auto last = std::find(motions_.rbegin(), motions_.rend(), motion);
    if (last == motions_.rend()) return false;
    const auto at = motions_.rend() - last - 1;
    motions_.erase(motions_.begin() + at);
    places_.erase(places_.begin() + at);
    return true;
  }

  Motion nearest(const Motion& motion) const override {
    if (motions_.empty()) throw ompl::Exception("No elements found in nearest neighbors data structure");
    const FlightPlace place = place_of(flight_state_of(motion->state_));
    std::size_t best = 0;
    double least = std::sqrt(squared_distance(places_[0], place)), enough = no_less_than(least);
    for (std::size_t i = 1; i < places_.size(); ++i) {
      const double squared = squared_distance(places_[i], place);
      if (squared > enough) continue;
      if (const double distance = std::sqrt(squared); distance < least)
        best = i, least = distance, enough = no_less_than(least);
    }
    return motions_[best];
  }

  void nearestK(const Motion& motion, std::size_t k, std::vector<Motion>& nearest) const override {
    if (k == 1 && !motions_.empty()) {  // what SST asks for
      nearest.assign(1, this->nearest(motion));
      return;
    }
    const FlightPlace place = place_of(flight_state_of(motion->state_));
    ranked_.clear();
    for (std::size_t i = 0; i < places_.size(); ++i)
      ranked_.emplace_back(std::sqrt(squared_distance(places_[i], place)), motions_[i]);
    k = std::min(k, ranked_.size());
    if (k < ranked_.size()) {
      std::partial_sort(ranked_.begin(), ranked_.begin() + static_cast<std::ptrdiff_t>(k), ranked_.end(),
                        is_nearer);
      ranked_.resize(k);
    } else {
      std::sort(ranked_.begin(), ranked_.end(), is_nearer);
    }
    give(nearest);
  }

  void nearestR(const Motion& motion, double radius, std::vector<Motion>& nearest) const override {
    const FlightPlace place = place_of(flight_state_of(motion->state_));
    const double enough = no_less_than(radius);
    ranked_.clear();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const double squared = squared_distance(places_[i], place);
      if (squared > enough) continue;
      if (const double distance = std::sqrt(squared); distance <= radius)
        ranked_.emplace_back(distance, motions_[i]);
    }
    std::sort(ranked_.begin(), ranked_.end(), is_nearer);
    give(nearest);
  }

  std::size_t size() const override { return motions_.size(); }
  void list(std::vector<Motion>& motions) const override { motions = motions_; }

 private:
  using Ranked = std::pair<double, Motion>;
  static bool is_nearer(const Ranked& one, const Ranked& other) { return one.first < other.first; }
  /// Squares beyond it need no root: rounding cannot bring them back.
  static double no_less_than(double distance) { return distance * distance * (1 + 1e-12); }
  void give(std::vector<Motion>& nearest) const {
    nearest.clear();
    for (const auto& [distance, motion] : ranked_) nearest.push_back(motion);
  }

  std::vector<Motion> motions_;
  std::vector<FlightPlace> places_;     ///< of motions_, one each
  mutable std::vector<Ranked> ranked_;  ///< room to work in, kept
};

}  // namespace understory
