#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/report/sheet_page.hpp"

namespace understory {

/// A campaign's comparison with its baseline, and the gate's verdict.
struct GatedCampaign {
  GateSides sides;
  Comparison comparison;
  GateVerdict verdict;
  std::string sentence;  ///< sentence_of()
};

/// What flies a flight of the campaign again: "understory fly forest --seed 7".
std::function<std::string(const FlightRow& row)> commands_of(const CampaignFolder& folder,
                                                             const Campaign& campaign,
                                                             const std::filesystem::path& data_root);

/// The page of a campaign: one HTML file that needs nothing else, with a replay of each lost flight that left
/// a track, of the first 500. `chapter`: before the flights. Throws MachineError where the page's program
/// cannot be read.
std::string campaign_page(const CampaignFolder& folder, const Campaign& campaign, const Collected& collected,
                          const std::filesystem::path& data_root,
                          const std::optional<GatedCampaign>& gated = std::nullopt,
                          const std::vector<SheetSection>& chapter = {});

}  // namespace understory
