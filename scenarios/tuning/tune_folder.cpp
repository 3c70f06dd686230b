#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/tuning/tuning.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Under each name what must not change between two runs that go on with each other.
Json manifest_of(const TuneFile& file, const std::string& renderer) {
  Json json;
  json["format"] = results_format;
  json["understory"] = understory_version;
  json["build"] = program_digest();
  json["file"] = file.text;
  json["scenario"] = scenario_to_text(file.scenario);
  json["renderer"] = renderer;
  return json;
}

}  // namespace

void prepare_tune_folder(const fs::path& folder, const TuneFile& file, const std::string& renderer,
                         bool resume) {
  const fs::path manifest_file = folder / "tune.json";
  const Json manifest = manifest_of(file, renderer);
  if (fs::exists(manifest_file)) {
    if (!resume)
      throw ScenarioError(
          fmt::format("{}: holds a tuning already: --resume goes on with it, --out names another folder",
                      folder.string()));
    std::ifstream stream(manifest_file, std::ios::binary);
    const Json held = Json::parse(std::string{std::istreambuf_iterator<char>(stream), {}}, nullptr, false);
    for (const auto& [key, value] : manifest.items())
      if (!held.is_object() || held.value(key, Json()) != value)
        throw ScenarioError(
            fmt::format("{}: {} changed: expected as it was begun; --out names another folder",
                        manifest_file.string(), key));
    return;
  }
  prepare_output_folder(folder);
  for (const char* log : {"trials.jsonl", "validation.jsonl", "sensitivity.jsonl"})
    if (fs::exists(folder / log))
      throw ScenarioError(fmt::format("{}: {}: expected none in a new folder", folder.string(), log));
  write_lasting_file(manifest_file, manifest.dump(1) + "\n");
}

}  // namespace understory
