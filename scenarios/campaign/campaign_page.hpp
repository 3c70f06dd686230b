#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/gate.hpp"

namespace understory {

/// A campaign's comparison with its baseline, and the gate's verdict.
struct GatedCampaign {
  std::string baseline;  ///< name of the baseline's folder
  Comparison comparison;
  GateVerdict verdict;
};

/// The page of a campaign: one HTML file that needs nothing else, with a replay of each lost flight that left
/// a track, of the first 500. Throws MachineError where the page's program cannot be read.
std::string campaign_page(const CampaignFolder& folder, const Campaign& campaign, const Collected& collected,
                          const std::filesystem::path& data_root,
                          const std::optional<GatedCampaign>& gated = std::nullopt);

}  // namespace understory
