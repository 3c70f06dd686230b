#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scenarios/flight/flight_story.hpp"
#include "scenarios/report/page.hpp"

namespace understory {

enum class PageDetail {
  everything,  ///< below 3 MB in base64
  compact      ///< the last two seconds, and the way there: below 30 kB in base64
};

/// Adds what a page draws of a flight, thinned to fit: its arrays, and in `facts` the charts of them, the
/// obstacle that was touched and how much was left out.
void add_flight(const FlightLog& log, const FlightStory& story, PageDetail detail, PageArrays& arrays,
                nlohmann::ordered_json& facts);

}  // namespace understory
