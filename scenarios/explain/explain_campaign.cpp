#include "scenarios/explain/explain_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/explain/explain_report.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// In the order of first appearance.
std::vector<std::string> distinct(const std::vector<ExplainedRow>& rows, std::string ExplainedRow::*field) {
  std::vector<std::string> values;
  for (const ExplainedRow& row : rows)
    if (std::ranges::find(values, row.*field) == values.end()) values.push_back(row.*field);
  return values;
}

std::vector<ExplainedRow> of_condition(const std::vector<ExplainedRow>& rows, const std::string& condition) {
  std::vector<ExplainedRow> some;
  std::ranges::copy_if(rows, std::back_inserter(some),
                       [&](const ExplainedRow& row) { return row.condition == condition; });
  return some;
}

}  // namespace

std::vector<ExplainedRow> explained_rows(const CampaignFolder& folder, const std::vector<FlightRow>& rows) {
  std::vector<ExplainedRow> explained;
  for (const FlightRow& row : rows) {
    const fs::path file = folder.explanation_file(row.id);
    const auto text = text_if_there(file);
    if (!text) continue;
    const auto [why, conclusion, evidence] = explanation_from_json(*text, file.string());
    ExplainedRow& one =
        explained.emplace_back(ExplainedRow{row.id, row.condition, row.seed, conclusion.cause, why.cause,
                                            conclusion.sentence, why.last_chance_s});
    for (const Effect& effect : why.effects) one.effects[effect.part] = effect.difference();
  }
  return explained;
}

Table causes_table(const std::vector<ExplainedRow>& rows) {
  const std::vector<std::string> causes = distinct(rows, &ExplainedRow::cause);
  Table table{{"condition", "explained"}};
  table.head.insert(table.head.end(), causes.begin(), causes.end());
  for (const std::string& condition : distinct(rows, &ExplainedRow::condition)) {
    const std::vector<ExplainedRow> own = of_condition(rows, condition);
    std::vector<std::string>& cells = table.rows.emplace_back();
    cells = {condition, fmt::format("{}", own.size())};
    for (const std::string& cause : causes)
      cells.push_back(fmt::format("{}", std::ranges::count(own, cause, &ExplainedRow::cause)));
  }
  return table;
}

Table savings_table(const std::vector<ExplainedRow>& rows) {
  constexpr std::size_t least_for_interval = 5;  // the bootstrap of fewer flights is too narrow
  Table table{{"condition", "ideal part", "flights", "saved, %", "95 %"}};
  std::vector<std::string> parts(ideal_part_names.begin(), ideal_part_names.end());
  parts.push_back("everything");
  for (const std::string& condition : distinct(rows, &ExplainedRow::condition))
    for (const std::string& part : parts) {
      std::vector<double> effects;
      for (const ExplainedRow& row : of_condition(rows, condition))
        if (const auto effect = row.effects.find(part); effect != row.effects.end())
          effects.push_back(100 * effect->second);
      if (effects.empty()) continue;
      const BootstrapEstimate saved = bootstrap(effects);
      table.add(condition, part, effects.size(), fmt::format("{:.0f}", saved.value),
                effects.size() < least_for_interval
                    ? "-"
                    : fmt::format("{:.0f} to {:.0f}", saved.interval.minimum, saved.interval.maximum));
    }
  return table;
}

std::vector<SheetSection> causes_chapter(const std::vector<ExplainedRow>& rows) {
  if (rows.empty()) return {};
  SheetSection causes{.title = "Why flights were lost", .table = causes_table(rows)};
  const std::vector<std::string> names = distinct(rows, &ExplainedRow::cause);
  for (const std::string& condition : distinct(rows, &ExplainedRow::condition)) {
    const std::vector<ExplainedRow> own = of_condition(rows, condition);
    SheetBar bar{condition, {}};
    for (const std::string& name : names)
      bar.parts.emplace_back(name, static_cast<double>(std::ranges::count(own, name, &ExplainedRow::cause)));
    causes.bars.push_back(std::move(bar));
  }
  SheetSection savings{.title = "What an ideal part would have saved", .table = savings_table(rows)};
  savings.text =
      "Share of the lost flights that survive with the part ideal, less the share that other noise saves; "
      "95 % intervals over the flights (BCa bootstrap), from five flights on.";
  Table flights{{"flight", "cause", "part", "last chance, s before the end", "in words"}};
  for (const ExplainedRow& row : rows)
    flights.add(row.id, row.cause, row.part,
                row.last_chance_s ? fmt::format("{:.2f}", *row.last_chance_s) : "-", row.sentence);
  return {causes, savings, {.title = "Explained flights", .table = flights}};
}

}  // namespace understory
