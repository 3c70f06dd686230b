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

/// Whether a time that stands there again is refused, or its pose skipped.
enum class Repeats { refused, skipped };

/// Reads a trajectory, in either of the two common forms. Throws InputError "file:line: what was expected" at
/// a broken line, and "file: ..." where there is nothing to read.
std::vector<TimedPose> read_poses(const std::filesystem::path& file, Repeats repeats = Repeats::refused);

/// The same from text; `name` stands for the file in messages. Where the first line that is no comment has no
/// comma, TUM's form: "t tx ty tz qx qy qz qw", parted by blanks; seconds, metres, rotation of body into
/// world. Else the EuRoC/ASL ground truth's: "t, px, py, pz, qw, qx, qy, qz, ...", parted by commas;
/// nanoseconds, metres; what follows (velocity, biases) is passed over. Times increase strictly.
std::vector<TimedPose> parse_poses(std::string_view text, const std::string& name,
                                   Repeats repeats = Repeats::refused);

/// The pose at t_ns: between its two neighbours the position linearly, the attitude along the shorter arc at
/// a constant rate. Nothing before the first or after the last pose; an end still counts 1 us outside, since
/// seconds that went through a double are that inexact. `poses`: times strictly increasing, from 0.
std::optional<Eigen::Isometry3d> pose_at(const std::vector<TimedPose>& poses, std::int64_t t_ns);

}  // namespace understory
