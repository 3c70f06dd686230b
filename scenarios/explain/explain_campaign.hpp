#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/report/sheet_page.hpp"

namespace understory {

/// A lost flight of a campaign that explain has explained.
struct ExplainedRow {
  std::string id, condition;
  std::uint64_t seed = 0;
  std::string cause, part, sentence;
  std::optional<double> last_chance_s;
  std::map<std::string, double> effects =
      {};  ///< by part: more of its redraws survive with it ideal, -1 .. 1
};

/// Of the rows that are explained, in their order. Throws ScenarioError where a file is none of explain's.
std::vector<ExplainedRow> explained_rows(const CampaignFolder& folder, const std::vector<FlightRow>& rows);

/// For each condition how many of its lost flights have which cause.
Table causes_table(const std::vector<ExplainedRow>& rows);

/// For each condition and part the share of its lost flights that the part would have saved: the mean of the
/// effects, with its interval over the flights.
Table savings_table(const std::vector<ExplainedRow>& rows);

/// Both, as a chapter of the campaign's page; nothing where no flight is explained.
std::vector<SheetSection> causes_chapter(const std::vector<ExplainedRow>& rows);

}  // namespace understory
