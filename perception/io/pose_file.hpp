#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace understory {

/// Where the body was at a moment.
struct TimedPose {
  std::int64_t t_ns = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  int line = 0;  ///< of its file, for messages
};

/// What to do with a pose that has the same time as the one before: refuse the file or skip the pose.
enum class Repeats { refused, skipped };

/// Reads a trajectory, in either of the two common forms. Throws InputError "file:line: what was expected" at
/// a broken line, and "file: ..." if there is nothing to read.
std::vector<TimedPose> read_poses(const std::filesystem::path& file, Repeats repeats = Repeats::refused);

/// The same from text; `name` stands for the file in messages. Where the first line that is no comment has no
/// comma, TUM's form: "t tx ty tz qx qy qz qw", separated by blanks; seconds, metres, rotation of body into
/// world. Else the EuRoC/ASL ground truth's: "t, px, py, pz, qw, qx, qy, qz, ...", separated by commas;
/// nanoseconds, metres; further values (velocity, biases) are ignored. Times increase strictly.
std::vector<TimedPose> parse_poses(std::string_view text, const std::string& name,
                                   Repeats repeats = Repeats::refused);

/// From one pose to the other: the position linearly, the attitude along the shorter arc at a constant rate.
/// `share`: 0 to 1 of the way.
Eigen::Isometry3d pose_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after, double share);

/// The pose at t_ns: pose_between its two neighbours. Nothing before the first or after the last pose, with a
/// margin of 1 us, because times in seconds that were once a double are that inexact. `poses`: times strictly
/// increasing, from 0.
std::optional<Eigen::Isometry3d> pose_at(const std::vector<TimedPose>& poses, std::int64_t t_ns);

}  // namespace understory
