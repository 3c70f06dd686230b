#include "scenarios/tuning/trial_log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

Json numbers_of(const std::vector<std::string>& names, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i)
    json[names[i]] = std::isfinite(values[i]) ? Json(values[i]) : Json(nullptr);
  return json;
}

std::string line_of(const Trial& trial, const std::vector<std::string>& parameters,
                    const std::vector<std::string>& figures) {
  Json json;
  json["trial"] = trial.number;
  json["parameters"] = numbers_of(parameters, trial.point);
  if (trial.refused.empty())
    json["figures"] = numbers_of(figures, trial.figures);
  else
    json["refused"] = trial.refused;
  return json.dump() + "\n";
}

/// False where `json` has not these names.
bool take_numbers(const Json& json, const std::vector<std::string>& names, std::vector<double>& values) {
  if (!json.is_object() || json.size() != names.size()) return false;
  for (const std::string& name : names) {
    if (!json.contains(name) || !(json[name].is_number() || json[name].is_null())) return false;
    values.push_back(json[name].is_null() ? std::numeric_limits<double>::quiet_NaN()
                                          : json[name].get<double>());
  }
  return true;
}

bool take_trial(const std::string& line, const std::vector<std::string>& parameters,
                const std::vector<std::string>& figures, Trial& trial) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object() || json.value("trial", -1) != trial.number || !json.contains("parameters") ||
      !take_numbers(json["parameters"], parameters, trial.point))
    return false;
  if (json.contains("refused") && json["refused"].is_string()) {
    trial.refused = json["refused"];
    return true;
  }
  return json.contains("figures") && take_numbers(json["figures"], figures, trial.figures);
}

}  // namespace

TrialLog::TrialLog(std::filesystem::path file, std::vector<std::string> parameters,
                   std::vector<std::string> figures, Measure measure)
    : file_(std::move(file)),
      parameters_(std::move(parameters)),
      figures_(std::move(figures)),
      measure_(std::move(measure)) {
  std::ifstream stream(file_, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    Trial trial;
    trial.number = static_cast<int>(held_.size());
    if (!take_trial(text.substr(begin, end - begin), parameters_, figures_, trial))
      throw ScenarioError(fmt::format("{}:{}: expected trial {}, whole, with this tuning's parameters",
                                      file_.string(), held_.size() + 1, held_.size()));
    held_.push_back(std::move(trial));
  }
  if (begin < text.size()) write_lasting_file(file_, text.substr(0, begin));
}

Trial TrialLog::evaluate(const Point& point) {
  const std::size_t number = evaluated_.size();
  const auto before = places_.find(point);
  Trial trial;
  if (number < held_.size()) {
    trial = held_[number];
    if (trial.point != point)
      throw ScenarioError(fmt::format("{}:{}: expected the parameters that this tuning tries there",
                                      file_.string(), number + 1));
  } else {
    trial = before != places_.end() ? evaluated_[before->second] : measure_(static_cast<int>(number), point);
    trial.number = static_cast<int>(number);
    trial.point = point;
    append(trial);
  }
  places_.emplace(point, number);
  evaluated_.push_back(trial);
  return trial;
}

void TrialLog::append(const Trial& trial) {
  const std::string line = line_of(trial, parameters_, figures_);
  const int file = open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const bool is_written =
      file >= 0 && write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const int reason = errno;
  if (file >= 0) close(file);
  if (!is_written)
    throw MachineError(fmt::format("{}: cannot be written: {}", file_.string(), std::strerror(reason)));
}

std::string to_csv(const std::vector<Trial>& trials, const std::vector<std::string>& parameters,
                   const std::vector<std::string>& figures) {
  std::string csv = fmt::format("trial,{},{}\n", fmt::join(parameters, ","), fmt::join(figures, ","));
  for (const Trial& trial : trials) {
    csv += fmt::format("{},{}", trial.number, fmt::join(trial.point, ","));
    for (std::size_t i = 0; i < figures.size(); ++i)
      csv += trial.figures.empty() || !std::isfinite(trial.figures[i])
                 ? ","
                 : fmt::format(",{:.6g}", trial.figures[i]);
    csv += "\n";
  }
  return csv;
}

}  // namespace understory
