#include "scenarios/tuning/tuning.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <limits>
#include <nlohmann/json.hpp>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string line_of(const Trial& trial, const std::vector<std::string>& parameters,
                    const std::vector<std::string>& figures) {
  Json json{{"trial", trial.number}, {"parameters", numbers_of(parameters, trial.point)}};
  if (trial.refused.empty())
    json["figures"] = numbers_of(figures, trial.figures);
  else
    json["refused"] = trial.refused;
  if (trial.dropped) json["dropped"] = true;
  return json_text(json) + "\n";
}

/// False where `json` has other names.
bool take_numbers(const Json& json, const std::vector<std::string>& names, std::vector<double>& values) {
  for (const std::string& name : names)
    values.push_back(json.at(name).is_null() ? std::numeric_limits<double>::quiet_NaN()
                                             : json.at(name).get<double>());
  return json.size() == names.size();
}

/// False where the line is not whole or of another tuning.
bool take_trial(const std::string& line, const std::vector<std::string>& parameters,
                const std::vector<std::string>& figures, Trial& trial) try {
  const Json json = parse_json(line);
  if (json.contains("refused")) trial.refused = json.at("refused");
  trial.dropped = json.value("dropped", false);
  return json.at("trial") == trial.number && take_numbers(json.at("parameters"), parameters, trial.point) &&
         (!trial.refused.empty() || take_numbers(json.at("figures"), figures, trial.figures));
} catch (const Json::exception&) {
  return false;
}

/// Under each name what must not change between two runs that go on with each other.
Json manifest_of(const TuneFile& file, const Identity& identity) {
  Json json{{"format", results_format},
            {"understory", understory_version},
            {"file", file.text},
            {"scenario", scenario_to_text(file.scenario)}};
  for (const auto& [name, digest] : identity) json[name] = digest;
  return json;
}

}  // namespace

Json numbers_of(const std::vector<std::string>& names, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) json[names[i]] = values[i];
  return json;
}

TrialLog::TrialLog(fs::path file, std::vector<std::string> parameters, std::vector<std::string> figures,
                   Measure measure)
    : file_(std::move(file)),
      parameters_(std::move(parameters)),
      figures_(std::move(figures)),
      measure_(std::move(measure)) {
  const std::string text = text_if_there(file_).value_or("");
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    Trial trial;
    trial.number = static_cast<int>(held_.size());
    if (!take_trial(text.substr(begin, end - begin), parameters_, figures_, trial))
      throw ScenarioError(fmt::format("{}:{}: must be trial {}, whole, with this tuning's parameters",
                                      file_.string(), held_.size() + 1, held_.size()));
    held_.push_back(std::move(trial));
  }
  if (begin < text.size()) write_whole_file(file_, text.substr(0, begin));
}

Trial TrialLog::evaluate(const Point& point) {
  const std::size_t number = evaluated_.size();
  const auto before = places_.find(point);
  Trial trial;
  if (number < held_.size()) {
    trial = held_[number];
    if (trial.point != point)
      throw ScenarioError(fmt::format("{}:{}: must hold the parameters that this tuning tries there",
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

void TrialLog::finish() const {
  if (held_.size() > evaluated_.size())
    throw ScenarioError(fmt::format("{}:{}: one trial too many: this tuning makes {}", file_.string(),
                                    evaluated_.size() + 1, evaluated_.size()));
}

void TrialLog::append(const Trial& trial) {
  const std::string line = line_of(trial, parameters_, figures_);
  const int file = open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const bool is_written = file >= 0 &&
                          write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
                          fdatasync(file) == 0;
  const int reason = errno;
  if (file >= 0) close(file);
  if (!is_written) refuse_output(file_, reason);
}

void prepare_tune_folder(FolderMark& mark, const fs::path& folder, const TuneFile& file, bool resume,
                         const Identity& identity) {
  const fs::path manifest_file = folder / "tune.json";
  const Json manifest = manifest_of(file, identity);
  if (mark.goes_on(resume)) {
    const Json held = parse_json(text_if_there(manifest_file).value_or(""));
    if (!held.is_object())
      throw ScenarioError(
          fmt::format("{}: not as `understory tune` writes it (no JSON object); --out "
                      "names another folder",
                      manifest_file.string()));
    for (const auto& [key, value] : manifest.items())
      if (!held.contains(key) || held[key] != value)
        throw ScenarioError(fmt::format("{}: {} changed since the tuning began; choose another --out",
                                        manifest_file.string(), key));
    return;
  }
  prepare_output_folder(folder);
  write_whole_file(manifest_file, json_text(manifest, 1) + "\n");
}

}  // namespace understory
