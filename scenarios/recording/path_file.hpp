#pragma once

#include <filesystem>
#include <vector>

#include "perception/io/pose_file.hpp"

namespace understory {

/// Poses to carry cameras along: TUM's or EuRoC's form (perception/io/pose_file.hpp), or a run folder's
/// trajectory.csv, of which the true pose counts. Throws ScenarioError in one line where there are fewer than
/// two, or where one cannot follow another: times that do not increase, more than 100 m/s, a quarter turn at
/// once.
std::vector<TimedPose> read_path(const std::filesystem::path& file);

/// Those at least 0.05 s apart, with both ends. Files round: at 200 Hz a tenth of a millimetre is 8 m/s^2 to
/// and fro.
std::vector<TimedPose> thinned(const std::vector<TimedPose>& poses);

}  // namespace understory
