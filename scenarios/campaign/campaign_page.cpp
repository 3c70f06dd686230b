#include "scenarios/campaign/campaign_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "scenarios/campaign/campaign_summary.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/flight/flight_page.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/report/page.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t maximum_tracks = 500;

/// A condition of the campaign, as people and the page's map see it.
struct ShownCondition {
  FlatKeys keys;
  std::string before_seed, after_seed;  ///< of the command that flies it
};

std::string command(const ShownCondition& condition, std::uint64_t seed) {
  return fmt::format("understory fly {} --seed {}{}", condition.before_seed, seed, condition.after_seed);
}

ShownCondition shown(const CampaignFolder& folder, const Condition& condition, const fs::path& data_root) {
  const Scenario scenario =
      scenario_from_text(condition.scenario_text, folder.condition_file(condition).string());
  const std::string arguments = arguments_that_fly(scenario, data_root);
  const std::string mark = fmt::format(" --seed {}", scenario.seed);
  const std::size_t at = arguments.find(mark);
  ShownCondition result{flat_keys(condition.scenario_text, condition.name), {}, {}};
  if (at == std::string::npos) {
    result.before_seed = fmt::format("conditions/{}.yaml", condition.name);
  } else {
    result.before_seed = arguments.substr(0, at);
    result.after_seed = arguments.substr(at + mark.size());
  }
  return result;
}

/// Keys that two conditions give different values, but for names and seeds.
std::vector<std::string> grid_keys(const std::vector<ShownCondition>& conditions) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : conditions.front().keys) {
    const bool differs = std::ranges::any_of(
        conditions, [&](const ShownCondition& other) { return value_in(other.keys, key) != value; });
    if (differs && key != "seed") keys.push_back(key);
  }
  return keys;
}

Json conditions_of(const Campaign& campaign, const std::vector<ShownCondition>& conditions,
                   const std::vector<std::string>& keys, const std::vector<ConditionSummary>& summaries) {
  Json list = Json::array();
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const std::string& name = campaign.conditions[i].name;
    Json values = Json::object();
    for (const std::string& key : keys) values[key] = value_in(conditions[i].keys, key);
    Json condition{{"name", name},
                   {"label", words_of(campaign.conditions[i], scenario_of_all(campaign.conditions))},
                   {"keys", values}};
    const auto summary = std::ranges::find(summaries, name, &ConditionSummary::condition);
    const ConditionSummary none;
    const ConditionSummary& of = summary == summaries.end() ? none : *summary;
    condition["flights"] = of.flown + of.failed_to_run;
    condition["flown"] = of.flown;
    condition["goals"] = of.goals;
    condition["share"] = of.flown > 0 ? Json(static_cast<double>(of.goals) / of.flown) : Json();
    condition["lower"] = of.success.minimum;
    condition["upper"] = of.success.maximum;
    condition["between_crashes_km"] = of.flown > 0 ? crash_distance_text(of) : "";
    list.push_back(std::move(condition));
  }
  return list;
}

Json survival_of(const Campaign& campaign, const std::vector<ConditionSummary>& summaries,
                 PageArrays& arrays) {
  Json list = Json::array();
  for (std::size_t i = 0; i < campaign.conditions.size(); ++i) {
    const auto summary =
        std::ranges::find(summaries, campaign.conditions[i].name, &ConditionSummary::condition);
    if (summary == summaries.end() || summary->flown == 0) continue;
    std::vector<float> values;
    const auto add = [&](double at, const SurvivalStep& step) {
      for (const double value : {at, step.share, step.interval.minimum, step.interval.maximum})
        values.push_back(static_cast<float>(value));
    };
    for (const SurvivalStep& step : summary->survival.steps) add(step.at, step);
    if (!summary->survival.steps.empty()) add(summary->survival.last_at, summary->survival.steps.back());
    const std::string name = fmt::format("survival_{}", i);
    arrays.add(name, 4, values);
    list.push_back({{"condition", i}, {"array", name}});
  }
  return list;
}

const std::vector<std::string> outcomes{"goal", "collision", "ground", "out_of_bounds", "time", "not_flown"};

struct Column {
  const char *name, *label, *unit;
  double (*value)(const FlightRow&);
};
constexpr Column columns[] = {
    {"progress_m", "progress", "m", [](const FlightRow& row) { return row.progress_m; }},
    {"mean_speed_mps", "mean speed", "m/s", [](const FlightRow& row) { return row.mean_speed_mps; }},
    {"minimum_clearance_m", "minimum clearance", "m",
     [](const FlightRow& row) { return row.minimum_clearance_m; }},
    {"position_error_max_m", "maximum position error", "m",
     [](const FlightRow& row) { return row.position_error_max_m; }},
    {"detections", "hits", "", [](const FlightRow& row) { return static_cast<double>(row.detections); }},
    {"fallbacks", "fallback plans", "",
     [](const FlightRow& row) { return static_cast<double>(row.planner.fallback); }},
    {"simulated_s", "time", "s", [](const FlightRow& row) { return row.simulated_s; }}};

/// The facts of a packed_part().
Json facts_in(const std::string& part) {
  std::uint32_t length = 0;
  if (part.size() < sizeof length) return Json();
  std::memcpy(&length, part.data(), sizeof length);
  return parse_json(part.substr(sizeof length, length));
}

void add_rows(const CampaignFolder& folder, const Campaign& campaign, const std::vector<FlightRow>& rows,
              const std::vector<ShownCondition>& conditions, PageContent& page, Json& facts) {
  std::map<std::string, std::size_t> number;
  for (std::size_t i = 0; i < campaign.conditions.size(); ++i) number[campaign.conditions[i].name] = i;
  std::vector<std::uint16_t> condition_of_row;
  std::vector<std::uint8_t> outcome_of_row;
  Json texts;
  for (const char* const name : {"ids", "seeds", "reasons", "touched", "commands"})
    texts[name] = Json::array();
  facts["tracks"] = Json::object();
  std::size_t tracks = 0, left_out = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const FlightRow& row = rows[i];
    const std::size_t condition = number.at(row.condition);
    condition_of_row.push_back(static_cast<std::uint16_t>(condition));
    const auto outcome = std::ranges::find(outcomes, row.flown() ? row.outcome : "not_flown");
    outcome_of_row.push_back(static_cast<std::uint8_t>(outcome - outcomes.begin()));
    texts["ids"].push_back(row.id);
    texts["seeds"].push_back(fmt::format("{}", row.seed));
    texts["reasons"].push_back(row.reason);
    texts["touched"].push_back(row.touched);
    texts["commands"].push_back(command(conditions[condition], row.seed));
    const fs::path track = folder.track_file(row.id);
    std::error_code ignored;
    if (!fs::exists(track, ignored)) continue;
    if (++tracks > maximum_tracks) {
      ++left_out;
      continue;
    }
    const std::string name = fmt::format("track-{}", i);
    page.parts.emplace_back(name, read_file(track, maximum_json_bytes));
    const Json told = facts_in(page.parts.back().second);
    if (!told.is_object())
      throw ScenarioError(fmt::format("{}: not a whole track of a flight", track.string()));
    texts["reasons"].back() = told.value("sentence", "");
    facts["tracks"][fmt::format("{}", i)] = name;
  }
  page.arrays.add("row_condition", 1, condition_of_row);
  page.arrays.add("row_outcome", 1, outcome_of_row);
  facts["columns"] = Json::array();
  for (const Column& column : columns) {
    std::vector<float> values;
    for (const FlightRow& row : rows)
      values.push_back(row.flown() ? static_cast<float>(column.value(row))
                                   : std::numeric_limits<float>::quiet_NaN());
    page.arrays.add(fmt::format("column_{}", column.name), 1, values);
    facts["columns"].push_back({{"name", column.name}, {"label", column.label}, {"unit", column.unit}});
  }
  facts["rows"] = std::move(texts);
  if (left_out > 0)
    facts["warning"] = fmt::format("{} lost flights have no replay here: a page holds {} at most.", left_out,
                                   maximum_tracks);
}

std::string outcome_of(const FlightRow& row) { return row.flown() ? row.outcome : "not flown"; }

Json gate_of(const GatedCampaign& gated) {
  Json pairs = Json::array();
  for (const ConditionComparison& condition : gated.comparison.conditions)
    for (const FlightPair& pair : condition.pairs)
      pairs.push_back({condition.condition, fmt::format("{}", pair.baseline.seed), outcome_of(pair.baseline),
                       outcome_of(pair.candidate)});
  const bool is_open = gated.verdict.verdict == Verdict::undecided;
  return {{"verdict", gated.verdict.passes() ? "passes"
                      : is_open              ? "undecided"
                                             : "fails"},
          {"title", fmt::format("The gate says of {} against {}: {}", gated.sides.candidate,
                                gated.sides.baseline, gated.verdict.name())},
          {"baseline", gated.sides.baseline},
          {"candidate", gated.sides.candidate},
          {"lines", {gated.sentence}},
          {"pairs", pairs}};
}

}  // namespace

std::function<std::string(const FlightRow& row)> commands_of(const CampaignFolder& folder,
                                                             const Campaign& campaign,
                                                             const fs::path& data_root) {
  std::map<std::string, ShownCondition> conditions;
  for (const Condition& condition : campaign.conditions)
    conditions[condition.name] = shown(folder, condition, data_root);
  return [conditions](const FlightRow& row) {
    const auto found = conditions.find(row.condition);
    return found == conditions.end() ? "" : command(found->second, row.seed);
  };
}

std::string campaign_page(const CampaignFolder& folder, const Campaign& campaign, const Collected& collected,
                          const fs::path& data_root, const std::optional<GatedCampaign>& gated,
                          const std::vector<SheetSection>& chapter) {
  const std::vector<FlightRow>& rows = collected.rows;
  const std::vector<ConditionSummary> summaries = summarise(rows);
  std::vector<ShownCondition> conditions;
  for (const Condition& condition : campaign.conditions)
    conditions.push_back(shown(folder, condition, data_root));
  std::vector<std::string> keys = grid_keys(conditions);
  // The reader's own keys come before the keys that follow from them.
  std::ranges::stable_partition(keys, [&](const std::string& key) {
    const auto& grid = campaign.conditions.front().grid;
    return std::ranges::find(grid, key, &std::pair<std::string, std::string>::first) != grid.end();
  });
  const auto goals = std::ranges::count_if(rows, &FlightRow::reached_goal);
  const auto flown = std::ranges::count_if(rows, &FlightRow::flown);
  PageContent page;
  page.title = campaign.name;
  Json facts{{"kind", "campaign"},
             {"title", campaign.name},
             {"program", fmt::format("understory {} ({})", understory_version, understory_commit)},
             {"warning", ""},
             {"sentence", fmt::format("{} of {} flights reached the goal.", goals, flown)}};
  if (collected.missing > 0 || flown < static_cast<std::ptrdiff_t>(rows.size()))
    facts["sentence"] =
        fmt::format("{} of {} flights reached the goal; {} were not flown, {} are missing.", goals, flown,
                    rows.size() - static_cast<std::size_t>(flown), collected.missing);
  facts["conditions"] = conditions_of(campaign, conditions, keys, summaries);
  facts["grid_keys"] = keys;
  facts["outcomes"] = outcomes;
  facts["survival"] = survival_of(campaign, summaries, page.arrays);
  add_rows(folder, campaign, rows, conditions, page, facts);
  facts["gate"] = gated ? gate_of(*gated) : Json();
  facts["sections"] = facts_of(chapter, page);
  page.facts = json_text(facts);
  return page_html(data_root, page);
}

}  // namespace understory
