#include "perception/io/pose_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "perception/io/text_file.hpp"
#include "perception/io/text_table.hpp"

namespace understory {
namespace {

constexpr std::int64_t ends_reach_ns = 1000;
constexpr double maximum_m = 1e8;        // beyond any projected map coordinates
constexpr double norm_tolerance = 0.01;  // published files round quaternions to a few digits

/// One way of writing a pose into a line: cell 0 is the time, 1 to 3 the position, 4 to 7 the quaternion.
struct Form {
  std::optional<std::int64_t> (*time)(std::string_view cell);
  std::array<std::size_t, 4> wxyz;  ///< cells of the quaternion
  bool more_may_follow;
  const char* expected;
};

constexpr Form tum{seconds_in, {7, 4, 5, 6}, false, "expected 't tx ty tz qx qy qz qw', t in seconds from 0"};
constexpr Form euroc{
    nanoseconds_in, {4, 5, 6, 7}, true, "expected 't,px,py,pz,qw,qx,qy,qz', t in nanoseconds from 0"};

TimedPose pose_in(const TableLine& line, const Form& form, const std::string& name) {
  if (line.cells.size() < 8 || (line.cells.size() > 8 && !form.more_may_follow))
    fail_at_line(name, line.number, form.expected);
  const auto t_ns = form.time(line.cells[0]);
  if (!t_ns) fail_at_line(name, line.number, form.expected);
  const auto number = [&](std::size_t cell) {
    const auto value = number_in(line.cells[cell]);
    if (!value) fail_at_line(name, line.number, form.expected);
    return *value;
  };
  const Eigen::Vector3d position_world(number(1), number(2), number(3));
  if (!(position_world.cwiseAbs().maxCoeff() <= maximum_m))
    fail_at_line(name, line.number, "the position must be within 1e8 m");
  const auto& [w, x, y, z] = form.wxyz;
  const Eigen::Quaterniond q_world_body(number(w), number(x), number(y), number(z));
  if (!(std::abs(q_world_body.norm() - 1) < norm_tolerance))
    fail_at_line(name, line.number, "the quaternion must have length 1");
  TimedPose pose;
  pose.t_ns = *t_ns;
  pose.T_world_body = Eigen::Translation3d(position_world) * q_world_body.normalized();
  return pose;
}

}  // namespace

std::vector<TimedPose> read_poses(const std::filesystem::path& file) {
  return parse_poses(read_file(file, maximum_table_bytes), file.string());
}

std::vector<TimedPose> parse_poses(std::string_view text, const std::string& name) {
  std::vector<TableLine> lines = table_lines(text, CellsParted::by_commas, name);
  const bool is_tum = lines.empty() || lines.front().cells.size() == 1;
  if (is_tum) lines = table_lines(text, CellsParted::by_blanks, name);
  std::vector<TimedPose> poses;
  poses.reserve(lines.size());
  for (const TableLine& line : lines) {
    const TimedPose pose = pose_in(line, is_tum ? tum : euroc, name);
    if (!poses.empty() && pose.t_ns <= poses.back().t_ns)
      fail_at_line(name, line.number, "times must increase from line to line");
    poses.push_back(pose);
  }
  if (poses.empty()) throw InputError(name + ": holds no pose");
  return poses;
}

std::optional<Eigen::Isometry3d> pose_at(const std::vector<TimedPose>& poses, std::int64_t t_ns) {
  const auto is_later = [](std::int64_t t, const TimedPose& pose) { return t < pose.t_ns; };
  const auto after = std::upper_bound(poses.begin(), poses.end(), t_ns, is_later);
  if (after == poses.begin()) {
    const bool at_start = !poses.empty() && poses.front().t_ns - t_ns <= ends_reach_ns;
    return at_start ? std::optional(poses.front().T_world_body) : std::nullopt;
  }
  const auto before = std::prev(after);
  if (after == poses.end()) {
    return t_ns - before->t_ns <= ends_reach_ns ? std::optional(before->T_world_body) : std::nullopt;
  }
  const double share =
      static_cast<double>(t_ns - before->t_ns) / static_cast<double>(after->t_ns - before->t_ns);
  const Eigen::Quaterniond from(before->T_world_body.linear()), to(after->T_world_body.linear());
  const Eigen::Vector3d position_world =
      (1 - share) * before->T_world_body.translation() + share * after->T_world_body.translation();
  return Eigen::Isometry3d(Eigen::Translation3d(position_world) * from.slerp(share, to));
}

}  // namespace understory
