#include "scenarios/campaign/gate_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/report/sheet_page.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

bool holds_campaign(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "campaign.json", ignored);
}

std::vector<fs::path> campaigns_in(const std::vector<std::string>& folders) {
  std::vector<fs::path> found;
  for (const fs::path folder : folders) {
    std::error_code ignored;
    if (holds_campaign(folder) || !fs::is_directory(folder, ignored)) {
      found.push_back(folder);
      continue;
    }
    std::vector<fs::path> within;
    for (const auto& entry : fs::directory_iterator(folder))
      if (holds_campaign(entry.path())) within.push_back(entry.path());
    std::ranges::sort(within);
    found.insert(found.end(), within.begin(), within.end());
  }
  return found;
}

BootstrapEstimate mean_over(const std::vector<FlightRow>& rows, double FlightRow::*figure) {
  std::vector<double> values;
  for (const FlightRow& row : rows)
    if (row.flown() && std::isfinite(row.*figure)) values.push_back(row.*figure);
  return bootstrap(values);
}

HistoryEntry entry_of(const ComparedCampaign& campaign) {
  HistoryEntry entry;
  entry.name = fs::weakly_canonical(campaign.folder.path).filename().string();
  entry.commit = campaign.campaign.commit;
  entry.flown = static_cast<int>(std::ranges::count_if(campaign.rows, &FlightRow::flown));
  entry.goals = static_cast<int>(std::ranges::count_if(campaign.rows, &FlightRow::reached_goal));
  entry.success = wilson_interval(entry.goals, entry.flown);
  entry.speed_mps = mean_over(campaign.rows, &FlightRow::mean_speed_mps);
  entry.clearance_m = mean_over(campaign.rows, &FlightRow::minimum_clearance_m);
  return entry;
}

double share(const HistoryEntry& entry) {
  return entry.flown > 0 ? static_cast<double>(entry.goals) / entry.flown : std::nan("");
}

std::string change_text(const HistoryEntry& entry) {
  if (entry.pairs == 0) return "-";
  return fmt::format("{:+.1f}{}", 100 * entry.difference, entry.change.empty() ? "" : ", " + entry.change);
}

Table table_of(const GateHistory& history) {
  Table table{{"campaign", "commit", "flown", "goal", "success % (95 %)", "m/s", "clearance m", "pairs",
               "points to the one before"}};
  for (const HistoryEntry& entry : history.entries)
    table.add(entry.name, entry.commit, entry.flown, entry.goals,
              fmt::format("{} ({:.1f} to {:.1f})", number_text(100 * share(entry), 1),
                          100 * entry.success.minimum, 100 * entry.success.maximum),
              number_text(entry.speed_mps.value, 2), number_text(entry.clearance_m.value, 2), entry.pairs,
              change_text(entry));
  return table;
}

std::string changes_text(const GateHistory& history) {
  std::string text;
  for (const HistoryEntry& entry : history.entries)
    if (!entry.change.empty())
      text += fmt::format("Success {} by {:.1f} percentage points at {} ({} pairs). ", entry.change,
                          100 * std::abs(entry.difference), entry.name, entry.pairs);
  return text.empty() ? "No campaign shows a change of success against the one before it." : text;
}

LinePlot curve(const GateHistory& history, const std::string& title, const std::string& label,
               const std::function<std::pair<double, Interval>(const HistoryEntry&)>& value_of) {
  LinePlot plot{.title = title, .x_label = "campaign", .y_label = label};
  Series series{.name = label, .mark = Mark::line_and_dots};
  for (const HistoryEntry& entry : history.entries) {
    const auto [value, interval] = value_of(entry);
    const auto place = static_cast<double>(series.x.size());
    series.x.push_back(place);
    series.y.push_back(value);
    series.low.push_back(interval.minimum);
    series.high.push_back(interval.maximum);
    plot.x_names.emplace_back(place, entry.name);
    if (!entry.change.empty())
      plot.references.push_back({place, fmt::format("success {} at {}", entry.change, entry.name), true});
  }
  plot.series.push_back(std::move(series));
  return plot;
}

}  // namespace

GateHistory history_of(const std::vector<std::string>& folders, const GateRule& rule) {
  std::vector<ComparedCampaign> campaigns;
  for (const fs::path& folder : campaigns_in(folders)) campaigns.push_back(read_compared(folder));
  if (campaigns.size() < 2)
    throw ScenarioError(fmt::format("--history {}: requires two campaigns or more, found {}",
                                    fmt::join(folders, " "), campaigns.size()));
  GateHistory history;
  const double enough = std::log(2.0 * static_cast<double>(campaigns.size() - 1) / rule.alpha);
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    HistoryEntry& entry = history.entries.emplace_back(entry_of(campaigns[i]));
    if (i == 0) continue;
    const PairedOutcomes goals = compare_campaigns(campaigns[i - 1].rows, campaigns[i].rows).all.goals;
    const SignCounts signs = signs_of(goals);
    entry.pairs = goals.pairs();
    entry.difference = goals.difference();
    if (log_evidence_above(signs, 0) >= enough) entry.change = "rose";
    if (log_evidence_above(signs.mirrored(), 0) >= enough) entry.change = "fell";
  }
  return history;
}

std::string history_text(const GateHistory& history) {
  return to_text(table_of(history)) + changes_text(history) + "\n";
}

std::string history_page(const GateHistory& history, const fs::path& data_root) {
  const auto of_estimate = [](const BootstrapEstimate& estimate) {
    return std::pair(estimate.value, estimate.interval);
  };
  const std::vector<LinePlot> plots{
      curve(history, "Success", "share that reached the goal",
            [](const HistoryEntry& entry) { return std::pair(share(entry), entry.success); }),
      curve(history, "Speed", "mean speed, m/s",
            [&](const HistoryEntry& entry) { return of_estimate(entry.speed_mps); }),
      curve(history, "Clearance", "mean of the minimum clearance, m",
            [&](const HistoryEntry& entry) { return of_estimate(entry.clearance_m); })};
  return sheet_page(data_root, "History of campaigns", changes_text(history),
                    {{.title = "Over the campaigns, with 95 % intervals", .plots = plots},
                     {.title = "Campaigns", .table = table_of(history)}});
}

}  // namespace understory
