#include "scenarios/campaign/gate_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/report/sheet_page.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> campaigns_in(const fs::path& folder) {
  std::error_code ignored;
  if (holds_campaign(folder) || !fs::is_directory(folder, ignored)) return {folder};
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (holds_campaign(entry.path())) found.push_back(entry.path());
  std::ranges::sort(found);
  return found;
}

/// A figure of a campaign's flights, with its 95 % interval.
BootstrapEstimate success_of(const ComparedCampaign& campaign) {
  const auto flown = static_cast<int>(std::ranges::count_if(campaign.rows, &FlightRow::flown));
  const auto goals = static_cast<int>(std::ranges::count_if(campaign.rows, &FlightRow::reached_goal));
  return {flown > 0 ? static_cast<double>(goals) / flown : std::nan(""), wilson_interval(goals, flown)};
}
BootstrapEstimate mean_over(const ComparedCampaign& campaign, double FlightRow::*figure) {
  std::vector<double> values;
  for (const FlightRow& row : campaign.rows)
    if (row.flown() && std::isfinite(row.*figure)) values.push_back(row.*figure);
  return bootstrap(values);
}
BootstrapEstimate speed_of(const ComparedCampaign& campaign) {
  return mean_over(campaign, &FlightRow::mean_speed_mps);
}
BootstrapEstimate clearance_of(const ComparedCampaign& campaign) {
  return mean_over(campaign, &FlightRow::minimum_clearance_m);
}

std::string name_of(const ComparedCampaign& campaign) {
  return fs::weakly_canonical(campaign.folder.path).filename().string();
}

Table table_of(const GateHistory& history) {
  const auto text = [](const BootstrapEstimate& figure, double unit, int decimals) {
    return fmt::format("{} ({} to {})", number_text(unit * figure.value, decimals),
                       number_text(unit * figure.interval.minimum, decimals),
                       number_text(unit * figure.interval.maximum, decimals));
  };
  Table table{{"campaign", "commit", "flights", "success %", "m/s", "clearance m", "pairs",
               "points to the one before"}};
  for (std::size_t i = 0; i < history.campaigns.size(); ++i) {
    const ComparedCampaign& campaign = history.campaigns[i];
    const PairedOutcomes goals = i == 0 ? PairedOutcomes() : history.changes[i - 1].goals;
    table.add(name_of(campaign), campaign.campaign.commit, campaign.rows.size(),
              text(success_of(campaign), 100, 1), text(speed_of(campaign), 1, 2),
              text(clearance_of(campaign), 1, 2), goals.pairs(),
              i == 0 ? "-" : fmt::format("{:+.1f} {}", 100 * goals.difference(), history.shown[i - 1]));
  }
  return table;
}

std::string changes_text(const GateHistory& history) {
  std::string text;
  for (std::size_t i = 0; i < history.changes.size(); ++i)
    if (!history.shown[i].empty())
      text += fmt::format("Success {} by {:.1f} percentage points at {} ({} pairs). ", history.shown[i],
                          100 * std::abs(history.changes[i].goals.difference()),
                          name_of(history.campaigns[i + 1]), history.changes[i].goals.pairs());
  return text.empty() ? "No campaign shows a change of success against the one before it." : text;
}

LinePlot curve(const GateHistory& history, const char* label,
               BootstrapEstimate (*figure_of)(const ComparedCampaign&)) {
  LinePlot plot{.title = label, .x_label = "campaign", .y_label = label};
  Series& series = plot.series.emplace_back(Series{.name = label, .mark = Mark::dots});
  for (std::size_t i = 0; i < history.campaigns.size(); ++i) {
    const BootstrapEstimate figure = figure_of(history.campaigns[i]);
    const auto place = static_cast<double>(i);
    series.add(place, figure.value, figure.interval.minimum, figure.interval.maximum);
    plot.x_names.emplace_back(place, name_of(history.campaigns[i]));
    if (i > 0 && !history.shown[i - 1].empty())
      plot.references.push_back({place, "success " + history.shown[i - 1], true});
  }
  return plot;
}

}  // namespace

GateHistory history_of(const std::vector<std::string>& folders, const GateRule& rule) {
  GateHistory history;
  for (const std::string& folder : folders)
    for (const fs::path& campaign : campaigns_in(folder))
      history.campaigns.push_back(read_compared(campaign));
  if (history.campaigns.size() < 2)
    throw ScenarioError(fmt::format("--history {}: requires two campaigns or more, found {}",
                                    fmt::join(folders, " "), history.campaigns.size()));
  for (std::size_t i = 1; i < history.campaigns.size(); ++i) {
    const ConditionComparison& change = history.changes.emplace_back(
        compare_campaigns(history.campaigns[i - 1].rows, history.campaigns[i].rows).all);
    const double enough = std::log(2.0 * static_cast<double>(i * (i + 1)) / rule.alpha);
    history.shown.emplace_back(log_evidence_above(change.signs(), 0) >= enough              ? "rose"
                               : log_evidence_above(change.signs().mirrored(), 0) >= enough ? "fell"
                                                                                            : "");
  }
  return history;
}

std::string history_text(const GateHistory& history) {
  return to_text(table_of(history)) + changes_text(history) + "\n";
}

std::string history_page(const GateHistory& history, const fs::path& data_root) {
  return sheet_page(data_root, "History of campaigns", changes_text(history),
                    {{.title = "Over the campaigns, with 95 % intervals",
                      .plots = {curve(history, "share that reached the goal", success_of),
                                curve(history, "mean speed, m/s", speed_of),
                                curve(history, "mean of the minimum clearance, m", clearance_of)}},
                     {.title = "Campaigns", .table = table_of(history)}});
}

}  // namespace understory
