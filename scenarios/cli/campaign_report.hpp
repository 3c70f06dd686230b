#pragma once

#include "scenarios/campaign/campaign_folder.hpp"

namespace understory {

/// Prints what a campaign came to and leaves summary.md and campaign.svg in its folder, and with a name of a
/// file there JUnit XML. Gives the exit status: 0 where every flight was flown, whatever its ending; 1 where
/// one was not.
int report(const CampaignFolder& folder, const Collected& collected, const std::filesystem::path& junit = {});

}  // namespace understory
