#include "scenarios/config/json_text.hpp"

#include <nlohmann/json.hpp>

namespace understory {

nlohmann::ordered_json parse_json(const std::string& text) {
  using Json = nlohmann::ordered_json;
  constexpr int maximum_depth = 16;
  struct TooDeep {};
  const auto bounded = [](int depth, Json::parse_event_t, Json&) {
    return depth <= maximum_depth ? true : throw TooDeep();
  };
  try {
    return Json::parse(text, bounded, false);
  } catch (const TooDeep&) {
    return Json(Json::value_t::discarded);
  }
}

}  // namespace understory
