#pragma once

#include <vector>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/recording/recording_choice.hpp"

namespace understory {

/// Makes the recordings in runs/ of a campaign a data set: scenes.csv lists them, LICENSE.txt says under
/// which terms they may be used, SHA256SUMS has a line for each file (`sha256sum --check` reads it). Throws
/// MachineError where sha256sum fails.
void write_data_set_files(const CampaignFolder& folder, const std::vector<FlightRow>& rows,
                          RecordingForm form);

}  // namespace understory
