#include "planning/flight_places.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

/// Beyond this factor a squared distance is larger even after rounding, so no root is needed.
double no_less_than(double distance) { return distance * distance * (1 + 1e-12); }

template <typename Ranked>
bool is_nearer(const Ranked& one, const Ranked& other) {
  return one.first < other.first;
}

}  // namespace

std::size_t FlightPlaces::nearest(const FlightPlace& place) const {
  std::size_t best = 0;
  double minimum = std::sqrt(squared_distance(places_.front(), place)), enough = no_less_than(minimum);
  for (std::size_t i = 1; i < places_.size(); ++i) {
    const double squared = squared_distance(places_[i], place);
    if (squared > enough) continue;
    if (const double distance = std::sqrt(squared); distance < minimum)
      best = i, minimum = distance, enough = no_less_than(minimum);
  }
  return best;
}

std::vector<std::size_t> FlightPlaces::nearest(const FlightPlace& place, std::size_t count) const {
  if (count == 1 && !places_.empty()) return {nearest(place)};  // what SST asks for
  ranked_.clear();
  for (std::size_t i = 0; i < places_.size(); ++i)
    ranked_.emplace_back(std::sqrt(squared_distance(places_[i], place)), i);
  count = std::min(count, ranked_.size());
  if (count < ranked_.size()) {
    std::partial_sort(ranked_.begin(), ranked_.begin() + static_cast<std::ptrdiff_t>(count), ranked_.end(),
                      is_nearer<Ranked>);
    ranked_.resize(count);
  } else {
    std::sort(ranked_.begin(), ranked_.end(), is_nearer<Ranked>);
  }
  return numbers();
}

std::vector<std::size_t> FlightPlaces::within(const FlightPlace& place, double radius) const {
  const double enough = no_less_than(radius);
  ranked_.clear();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const double squared = squared_distance(places_[i], place);
    if (squared > enough) continue;
    if (const double distance = std::sqrt(squared); distance <= radius) ranked_.emplace_back(distance, i);
  }
  std::sort(ranked_.begin(), ranked_.end(), is_nearer<Ranked>);
  return numbers();
}

std::vector<std::size_t> FlightPlaces::numbers() const {
  std::vector<std::size_t> numbers;
  for (const auto& [distance, number] : ranked_) numbers.push_back(number);
  return numbers;
}

}  // namespace understory
