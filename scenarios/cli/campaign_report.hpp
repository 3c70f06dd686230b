#pragma once

#include "scenarios/campaign/campaign_folder.hpp"

namespace understory {

/// Prints what a campaign came to and leaves summary and plots in its folder. Gives the exit status: 0 where
/// every flight was flown, whatever its ending; 1 where one was not.
int report(const CampaignFolder& folder, const Collected& collected);

}  // namespace understory
