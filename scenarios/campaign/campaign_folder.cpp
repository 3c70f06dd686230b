#include "scenarios/campaign/campaign_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/render/renderer_kind.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* manifest_name = "campaign.json";

/// What must be a campaign's description is none.
[[noreturn]] void refuse_manifest(const CampaignFolder& folder, const std::string& key,
                                  const std::string& expected) {
  refuse_input((folder.path / manifest_name).string(), key, expected);
}

std::string manifest_of(const Campaign& campaign) {
  Json conditions = Json::array();
  for (const Condition& condition : campaign.conditions) {
    Json grid = Json::object();
    for (const auto& [key, value] : condition.grid) grid[key] = value;
    conditions.push_back({{"name", condition.name},
                          {"scenario", condition.scenario},
                          {"variant", condition.variant},
                          {"seed_offset", condition.seed_offset},
                          {"grid", grid}});
  }
  Json identity = Json::object();
  for (const auto& [name, digest] : campaign.identity) identity[name] = digest;
  Json pictures = Json::object();
  for (const auto& [scenery, digest] : campaign.pictures) pictures[scenery] = digest;
  Json json{{"format", results_format},        {"understory", understory_version},
            {"commit", understory_commit},     {"identity", identity},
            {"processor", processor_model()},  {"name", campaign.name},
            {"renderer", campaign.renderer},   {"pictures", pictures},
            {"timeout_s", campaign.timeout_s}, {"conditions", conditions},
            {"seeds", campaign.seeds}};
  if (campaign.recording.form)
    json.update({{"record", word_for(*campaign.recording.form)}, {"every", campaign.recording.every}});
  return json_text(json, 1) + "\n";
}

Json manifest_in(const CampaignFolder& folder) {
  const fs::path file = folder.path / manifest_name;
  const auto text = text_if_there(file);
  if (!text)
    throw ScenarioError(
        fmt::format("{}: not a folder of a campaign: {} is missing", folder.path.string(), manifest_name));
  const Json json = parse_json(*text);
  if (!json.is_object() || !json.contains("format"))
    throw ScenarioError(fmt::format("{}: not a whole description of a campaign", file.string()));
  if (!json["format"].is_number_integer() || json["format"] != results_format)
    throw ScenarioError(fmt::format("{}: format: must be {}, these results are of another version: {}",
                                    file.string(), results_format, json_text(json["format"])));
  return json;
}

/// Says in one line what keeps `folder` from going on with `campaign`.
void require_same(const CampaignFolder& folder, const Campaign& campaign, bool may_grow) {
  const Campaign held = read_campaign(folder);
  const auto refuse = [&](const std::string& what) {
    throw ScenarioError(fmt::format("{}: {}: the campaign was begun with another one; choose another --out",
                                    (folder.path / manifest_name).string(), what));
  };
  require_identity(folder, held, campaign.identity);
  const std::set<std::uint64_t> before(held.seeds.begin(), held.seeds.end());
  const std::set<std::uint64_t> now(campaign.seeds.begin(), campaign.seeds.end());
  if (may_grow ? !std::ranges::includes(now, before) : held.seeds != campaign.seeds) refuse("seeds changed");
  if (held.renderer != campaign.renderer) refuse("renderer changed");
  if (held.timeout_s != campaign.timeout_s) refuse("timeout_s changed");
  if (held.recording != campaign.recording) refuse("--record or --every changed");
  for (const Condition& condition : campaign.conditions) {
    const auto same = [&](const Condition& other) {
      return other.name == condition.name && other.scenario_text == condition.scenario_text &&
             other.seed_offset == condition.seed_offset;
    };
    if (std::ranges::none_of(held.conditions, same)) refuse("condition " + condition.name + " changed");
  }
  if (held.conditions.size() != campaign.conditions.size()) refuse("a condition is gone");
}

/// The columns cause and part, empty where the flight is not explained.
void add_cause(const CampaignFolder& folder, FlightRow& row) {
  const auto text = text_if_there(folder.explanation_file(row.id));
  const auto json = text ? parse_json(*text) : Json();
  for (const char* key : {"cause", "part"})
    row.more.emplace_back(key, json.is_object() ? json.value(key, "") : "");
}

}  // namespace

std::string plain_name(std::string text) {
  for (char& c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 &&
        std::string_view("._=-").find(c) == std::string_view::npos)
      c = '_';
  // A cell of a table that begins with = or - is a formula to spreadsheets.
  if (text.starts_with('=') || text.starts_with('-')) text[0] = '_';
  return text;
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && name.size() <= 200 && !name.starts_with('.') && plain_name(name) == name;
}

void require_identity(const CampaignFolder& folder, const Campaign& held, const Identity& identity) {
  const std::string name = difference_of(held.identity, identity);
  if (!name.empty()) refuse_manifest(folder, name, "changed since the campaign began; choose another --out");
}

std::optional<std::string> text_if_there(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  return read_file(file, maximum_table_bytes);
}

std::string words_of(const Condition& condition, const std::string& titled_scenario,
                     std::string_view but_for) {
  std::vector<std::string> words;
  if (condition.scenario != titled_scenario) words.push_back(condition.scenario);
  if (!condition.variant.empty()) words.push_back(condition.variant);
  for (const auto& [key, value] : condition.grid)
    if (key != but_for) words.push_back(short_key(key) + "=" + value);
  return words.empty() ? condition.scenario : fmt::format("{}", fmt::join(words, ", "));
}

std::string scenario_of_all(const std::vector<Condition>& conditions) {
  const auto differs = [&](const Condition& one) { return one.scenario != conditions[0].scenario; };
  return conditions.empty() || std::ranges::any_of(conditions, differs) ? "" : conditions[0].scenario;
}

std::vector<CampaignTask> tasks_of(const Campaign& campaign) {
  std::vector<CampaignTask> tasks;
  for (std::size_t condition = 0; condition < campaign.conditions.size(); ++condition)
    for (const std::uint64_t base : campaign.seeds) {
      const std::uint64_t seed = base + campaign.conditions[condition].seed_offset;
      tasks.push_back({fmt::format("{}-{}", campaign.conditions[condition].name, seed), condition, seed});
    }
  return tasks;
}

std::vector<CampaignTask> in_flying_order(const Campaign& campaign) {
  const std::vector<CampaignTask> tasks = tasks_of(campaign);
  const std::size_t seeds = campaign.seeds.size();
  std::vector<CampaignTask> order;
  for (std::size_t seed = 0; seed < seeds; ++seed)
    for (std::size_t condition = 0; condition < campaign.conditions.size(); ++condition)
      order.push_back(tasks[condition * seeds + seed]);
  return order;
}

void prepare_campaign_folder(FolderMark& mark, const CampaignFolder& folder, const Campaign& campaign,
                             bool resume, bool may_grow) {
  if (mark.goes_on(resume)) require_same(folder, campaign, may_grow);
  for (const char* part : {"conditions", "flights", "tracks", "logs"})
    prepare_output_folder(folder.path / part);
  for (const Condition& condition : campaign.conditions)
    write_whole_file(folder.condition_file(condition), condition.scenario_text);
  write_whole_file(folder.path / manifest_name, manifest_of(campaign));  // last: now it is a campaign
}

bool holds_campaign(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / manifest_name, ignored);
}

Campaign read_campaign(const CampaignFolder& folder) {
  const Json json = manifest_in(folder);
  Campaign campaign;
  std::set<std::string> names;
  const char* key = "name";
  try {
    campaign.name = json.at(key);
    campaign.renderer = json.at(key = "renderer");
    campaign.timeout_s = json.at(key = "timeout_s");
    if (campaign.timeout_s < 1 || campaign.timeout_s > 86400)
      refuse_manifest(folder, key, "must be from 1 to 86400");
    if (campaign.renderer != word_for(RendererKind::osmesa) &&
        campaign.renderer != word_for(RendererKind::egl))
      refuse_manifest(folder, "renderer", "must be osmesa or egl");
    for (const char* list : {"seeds", "conditions"})
      if (!json.at(key = list).is_array() || json[key].empty())
        refuse_manifest(folder, key, "must be a list with at least one entry");
    for (const Json& seed : json.at(key = "seeds")) {
      if (!seed.is_number_unsigned() || seed > maximum_seed)
        refuse_manifest(folder, key, "must be whole numbers from 0 to 2^32");
      campaign.seeds.push_back(seed);
    }
    for (const Json& held : json.at(key = "conditions")) {
      Condition& condition = campaign.conditions.emplace_back();
      condition.name = held.at("name");
      condition.scenario = held.at("scenario");
      condition.variant = held.at("variant");
      condition.seed_offset = held.value("seed_offset", condition.seed_offset);
      for (const auto& [name, value] : held.at("grid").items()) condition.grid.emplace_back(name, value);
      const bool is_new = names.insert(campaign.conditions.back().name).second;
      if (!is_plain_name(campaign.conditions.back().name) || !is_new)
        refuse_manifest(folder, key, "must be different names of letters, digits and . _ = -");
    }
    if (json.contains(key = "identity"))
      for (const auto& [name, digest] : json.at(key).items()) campaign.identity.emplace_back(name, digest);
    if (json.contains(key = "pictures"))
      for (const auto& [scenery, digest] : json.at(key).items())
        campaign.pictures.emplace_back(scenery, digest);
    campaign.commit = json.value(key = "commit", "");
    if (json.contains(key = "record")) {
      const auto* form = std::ranges::find(recording_forms, json.at(key).get<std::string>(),
                                           [](const auto& one) { return one.first; });
      if (form == recording_forms.end()) refuse_manifest(folder, key, "must be euroc, kitti or middlebury");
      campaign.recording = {form->second, json.value("every", 1)};
    }
  } catch (const Json::exception&) {
    refuse_manifest(folder, key, "not as `understory campaign` writes it");
  }
  if (std::set(campaign.seeds.begin(), campaign.seeds.end()).size() != campaign.seeds.size())
    refuse_manifest(folder, "seeds", "must all be different");
  for (Condition& condition : campaign.conditions) {
    const auto text = text_if_there(folder.condition_file(condition));
    if (!text)
      throw ScenarioError(
          fmt::format("{}: the condition's scenario is missing", folder.condition_file(condition).string()));
    condition.scenario_text = *text;
  }
  return campaign;
}

std::optional<FlightFile> read_flight(const CampaignFolder& folder, const CampaignTask& task) {
  const auto text = text_if_there(folder.flight_file(task));
  auto file = text ? flight_file_from_json(*text) : std::nullopt;
  if (!file) return {};
  const FlightRow& row = file->row;
  if (row.id != task.id || row.id != fmt::format("{}-{}", row.condition, task.seed) || row.seed != task.seed)
    return {};
  return file;
}

void write_flight(const CampaignFolder& folder, const Campaign& campaign, const CampaignTask& task,
                  FlightFile file) {
  file.row.id = task.id;
  file.row.condition = campaign.conditions[task.condition].name;
  file.row.seed = task.seed;
  write_whole_file(folder.flight_file(task), to_json(file));  // as the flight itself
}

Collected gather(const CampaignFolder& folder, const Campaign& campaign) {
  Collected collected;
  ProgressLine line;
  const std::vector<CampaignTask> tasks = tasks_of(campaign);
  std::error_code ignored;
  const bool is_explained = fs::exists(folder.explanation_file("").parent_path(), ignored);
  for (const CampaignTask& task : tasks) {
    const std::size_t done = collected.rows.size() + collected.missing;
    line.show(fmt::format("{} of {} flights gathered", done, tasks.size()), done, tasks.size() - done);
    const auto file = read_flight(folder, task);
    if (!file) {
      collected.missing += 1;
      continue;
    }
    collected.rows.push_back(file->row);
    collected.rows.back().more = campaign.conditions[task.condition].grid;
    if (is_explained) add_cause(folder, collected.rows.back());
    collected.costs.push_back(file->cost);
  }
  return collected;
}

Collected collect(const CampaignFolder& folder, const Campaign& campaign) {
  const Collected collected = gather(folder, campaign);
  std::string lines;
  Table costs{{"id", "wall_s", "peak_memory_mb"}};
  for (std::size_t i = 0; i < collected.rows.size(); ++i) {
    const FlightCost& cost = collected.costs[i];
    lines += to_json_line(collected.rows[i]) + "\n";
    costs.add(collected.rows[i].id, number_text(cost.wall_s, 3), number_text(cost.peak_memory_mb, 1));
  }
  write_whole_file(folder.path / "flights.csv", to_csv(collected.rows));
  write_whole_file(folder.path / "flights.jsonl", lines);
  write_whole_file(folder.path / "costs.csv", to_csv(costs));
  return collected;
}

std::vector<FlightRow> read_campaign_rows(const fs::path& folder) {
  const fs::path file = folder / "flights.csv";
  const auto text = text_if_there(file);
  if (!text)
    throw ScenarioError(fmt::format("{}: not a campaign's results: flights.csv is missing", folder.string()));
  return rows_from_csv(*text, file.string());
}

}  // namespace understory
