#include "scenarios/output/result_kinds.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "scenarios/output/file_output.hpp"

namespace understory {

namespace fs = std::filesystem;

const ResultKind flight_results{
    .name = "flight",
    .commands = "fly record",
    .manifest = "scenario.yaml",
    .last = "result.json",
    .patterns = {"result.json", "scenario.yaml", "flight.log", "trajectory.csv", "map.ply", "obstacles.csv",
                 "truth.tum", "estimate.tum", "flight.mp4", "still.png", "mav0/*/*.csv", "mav0/*/sensor.yaml",
                 "mav0/*/data/*.png", "training/*/*", "training/*.txt", "pairs/*/*", "pairs/*.txt"},
    .added = {"report.html", "flight.mcap", "explain.json"}};

const ResultKind campaign_results{
    .name = "campaign",
    .commands = "campaign",
    .manifest = "campaign.json",
    .last = "summary.md",
    .grows = true,
    .patterns = {"campaign.json", "flights.csv", "flights.jsonl", "costs.csv", "summary.md", "campaign.svg",
                 "slurm.sh", "scenes.csv", "LICENSE.txt", "SHA256SUMS", "conditions/*.yaml", "flights/*",
                 "tracks/*", "logs/*", "runs/*", "explained/*"},
    .added = {"report.html"}};

const ResultKind tuning_results{
    .name = "tuning",
    .commands = "tune",
    .manifest = "tune.json",
    .last = "report.html",
    .grows = true,
    .patterns = {"tune.json", "trials.jsonl", "validation.jsonl", "sensitivity.jsonl", "trials.csv",
                 "pareto.csv", "summary.md", "tune.svg", "best.yaml", "report.html", "front/*.yaml",
                 "flown/*/*/*"}};

const ResultKind evaluation_results{
    .name = "evaluation",
    .commands = "evaluate",
    .manifest = "",
    .last = "summary.md",
    .patterns = {"summary.md", "report.html", "evaluation.json", "obstacles.csv", "precision_recall.svg",
                 "response.svg", "first_hits.svg", "distances.svg", "heat_map.png", "heat_map_paper.png",
                 "tables/*.csv", "worst/*.png"}};

const ResultKind detection_results{
    .name = "detection",
    .commands = "detect",
    .manifest = "",
    .last = "points.csv",
    .patterns = {"points.csv", "points.ply", "timings.csv", "map.ply", "overlay.mp4", "overlays/*.png"}};

namespace {

const std::array kinds{&flight_results, &campaign_results, &tuning_results, &evaluation_results,
                       &detection_results};

bool matches(const fs::path& file, const ResultKind& kind) {
  const auto means = [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), file.c_str(), FNM_PATHNAME) == 0;
  };
  return std::ranges::any_of(kind.patterns, means) || std::ranges::any_of(kind.added, means);
}

}  // namespace

const ResultKind* results_of(std::string_view command) {
  for (const ResultKind* kind : kinds)
    if (fmt::format(" {} ", kind->commands).find(fmt::format(" {} ", command)) != std::string::npos)
      return kind;
  return nullptr;
}

std::vector<std::string> names_of(const ResultKind& kind) {
  std::vector<std::string> names;
  std::ranges::copy_if(kind.patterns, std::back_inserter(names),
                       [](const std::string& pattern) { return pattern.find('*') == std::string::npos; });
  return names;
}

void require_outside(const fs::path& output, const fs::path& folder, std::string_view allowed) {
  const fs::path within = path_within(output, folder);
  const bool is_result =
      std::ranges::any_of(kinds, [&](const ResultKind* kind) { return matches(within, *kind); });
  if (is_result && within != allowed) refuse_other_use(output, "results are read or written there");
}

std::vector<std::string> files_of(const fs::path& folder, const ResultKind& kind) {
  std::vector<std::string> files;
  for (const std::string& file : files_below(folder))
    if (matches(file, kind)) files.push_back(file);
  return files;
}

}  // namespace understory
