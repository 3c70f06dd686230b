#include "scenarios/tuning/asked_tuning.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/tuning/tuning.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

/// Throws ScenarioError unless `json` has a number, or null, of each name and nothing else.
std::vector<double> numbers_in(const Json& json, const std::vector<std::string>& names, const char* what) {
  std::vector<double> values;
  for (const std::string& name : names) {
    const Json value = json.is_object() ? json.value(name, Json("missing")) : Json("missing");
    if (!value.is_number() && !value.is_null())
      throw ScenarioError(fmt::format("{}: expected a number of each of {}", what, fmt::join(names, ", ")));
    values.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>());
  }
  if (json.size() != names.size())
    throw ScenarioError(fmt::format("{}: expected {} and nothing else", what, fmt::join(names, ", ")));
  return values;
}

/// Leaves a search at the first point that nobody has told of.
struct Asked {
  Point point;
};

std::optional<Point> next_point(const TuneFile& file, const std::vector<Figures>& told) {
  std::size_t next = 0;
  try {
    search(file.space, file.objective, file.search, [&](const Point& point) {
      if (next == told.size()) throw Asked{point};
      return told[next++];
    });
  } catch (const Asked& asked) {
    return asked.point;
  }
  return {};
}

Json answer_to(const Measured& measured, const Judge& judge, const std::vector<std::string>& names) {
  if (!measured.refused.empty()) return {{"refused", measured.refused}};
  return {{"figures", numbers_of(names, judge.figures(measured.units))}};
}

}  // namespace

std::string AskedTuning::greeting() const {
  Json json{
      {"parameters", Json::array()},   {"figures", file_.figures},
      {"maximize", Json::array()},     {"minimize", Json::array()},
      {"trials", file_.search.trials}, {"scenario", numbers_of(keys_of(file_.space), file_.scenario_point)}};
  for (const Parameter& parameter : file_.space.parameters) {
    Json one{{"key", parameter.key}, {"whole", parameter.whole}};
    if (parameter.values.empty())
      one.update({{"from", parameter.from}, {"to", parameter.to}, {"log", parameter.logarithmic}});
    else
      one["values"] = parameter.values;
    json["parameters"].push_back(one);
  }
  for (const Goal& goal : file_.objective.goals)
    json[goal.maximize ? "maximize" : "minimize"].push_back(file_.figures[goal.figure]);
  return json_text(json);
}

std::string AskedTuning::answer(const std::string& question) try {
  const Json json = parse_json(question);
  const std::vector<std::string> keys = keys_of(file_.space);
  const auto is = [&](const char* name) { return json.is_object() && json.contains(name); };
  if (is("ask")) {
    if (!asked_) asked_ = next_point(file_, figures_);
    if (!asked_) return json_text({{"trial", Json()}});
    return json_text({{"trial", points_.size() + 1}, {"parameters", numbers_of(keys, *asked_)}});
  }
  if (is("tell")) {
    if (!asked_ || json["tell"] != points_.size() + 1)
      throw ScenarioError("tell: expected the number of the trial that was asked last, once");
    const bool is_refused = !is("figures") || json["figures"].is_null();
    figures_.push_back(is_refused ? Figures() : numbers_in(json["figures"], file_.figures, "figures"));
    points_.push_back(*asked_);
    asked_.reset();
    const auto best = best_of(file_.objective, figures_);
    return json_text({{"best", best ? Json(*best + 1) : Json()}});
  }
  if (is("measure")) {
    const std::string data = json.value("data", "training");
    if (data != "training" && data != "validation")
      throw ScenarioError("data: expected training | validation, got " + data);
    const Point point = numbers_in(json["measure"], keys, "measure");
    Judge& judge = judge_of_(data == "validation");
    const Measured measured = measure_at(point, file_, judge, fmt::format("asked-{}", ++measured_));
    return json_text(answer_to(measured, judge, file_.figures));
  }
  throw ScenarioError(R"(expected {"ask": true}, {"tell": N, "figures": {...}} or {"measure": {...}})");
} catch (const ScenarioError& error) {
  return json_text({{"error", error.what()}});
} catch (const Json::exception& error) {
  return json_text({{"error", error.what()}});
}

}  // namespace understory
