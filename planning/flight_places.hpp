#pragma once

#include <Eigen/Core>
#include <cstddef>
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

/// Places, numbered in the order they were added, and a linear search for the nearest. The answers and their
/// order are those of ompl::NearestNeighborsLinear. It is faster, because the places lie side by side in
/// memory, no distance is computed twice, and roots are taken only where they decide. Not thread safe, not
/// even to read.
class FlightPlaces {
 public:
  void clear() { places_.clear(); }
  void add(const FlightPlace& place) { places_.push_back(place); }
  /// The numbers of later places decrease by one.
  void remove(std::size_t number) { places_.erase(places_.begin() + static_cast<std::ptrdiff_t>(number)); }
  std::size_t size() const { return places_.size(); }

  /// The first of those nearest to `place`; there must be one.
  std::size_t nearest(const FlightPlace& place) const;
  /// The `count` nearest, or all where they are fewer, nearest first.
  std::vector<std::size_t> nearest(const FlightPlace& place, std::size_t count) const;
  /// Those at most `radius` away, nearest first.
  std::vector<std::size_t> within(const FlightPlace& place, double radius) const;

 private:
  using Ranked = std::pair<double, std::size_t>;
  std::vector<std::size_t> numbers() const;

  std::vector<FlightPlace> places_;
  mutable std::vector<Ranked> ranked_;  ///< room to work in, kept
};

}  // namespace understory
