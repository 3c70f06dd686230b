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

/// Seconds; nanoseconds where they have 16 digits or more, as ORB-SLAM3 writes them.
std::optional<std::int64_t> seconds_or_ns_in(std::string_view cell) {
  constexpr std::size_t digits_of_ns = 16;
  const std::string_view whole = cell.substr(0, cell.find('.'));
  return whole.size() < digits_of_ns ? seconds_in(cell)
         : number_in(cell)           ? nanoseconds_in(whole)
                                     : std::nullopt;
}

/// The first line that holds anything but a comment.
std::string_view first_line(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const std::size_t begin = line.find_first_not_of("\xEF\xBB\xBF \t\r\v\f");
    if (begin != std::string_view::npos && line[begin] != '#') return line;
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return {};
}

/// One way of writing a pose into a line: cell 0 is the time, 1 to 3 the position, 4 to 7 the quaternion.
struct Form {
  std::optional<std::int64_t> (*time)(std::string_view cell);
  std::array<std::size_t, 4> wxyz;  ///< cells of the quaternion
  bool more_may_follow;
  const char* expected;
};

constexpr Form tum{
    seconds_or_ns_in, {7, 4, 5, 6}, false, "expected 't tx ty tz qx qy qz qw', t in seconds from 0"};
constexpr Form euroc{
    nanoseconds_in, {4, 5, 6, 7}, true, "expected 't,px,py,pz,qw,qx,qy,qz', t in nanoseconds from 0"};

constexpr Column time_column{"timestamp|time|t|stamp|t_s|t_ns|time_s|time_ns|timestamp_s|timestamp_ns",
                             "s|ns|sec|nsec"};
constexpr Column px{"p_rs_r_x|p_x|px|tx|t_x|x|x_m|pos_x", "m"}, py{"p_rs_r_y|p_y|py|ty|t_y|y|y_m|pos_y", "m"},
    pz{"p_rs_r_z|p_z|pz|tz|t_z|z|z_m|pos_z", "m"}, qw{"q_rs_w|q_w|qw|quat_w"}, qx{"q_rs_x|q_x|qx|quat_x"},
    qy{"q_rs_y|q_y|qy|quat_y"}, qz{"q_rs_z|q_z|qz|quat_z"};
constexpr std::array tum_columns{time_column, px, py, pz, qx, qy, qz, qw},
    euroc_columns{time_column, px, py, pz, qw, qx, qy, qz};

/// The form with the time in the unit that the table's own name of it states.
Form with_named_time(Form form, const std::string& name) {
  if (name.ends_with("_ns") || name.find("[ns") != std::string::npos) form.time = nanoseconds_in;
  if (name.ends_with("_s") || name.find("[s") != std::string::npos) form.time = seconds_in;
  form.expected = "expected numbers under the columns' names; times from 0, in seconds as t_s, in ns as t_ns";
  return form;
}

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
  pose.line = line.number;
  pose.T_world_body = Eigen::Translation3d(position_world) * q_world_body.normalized();
  return pose;
}

}  // namespace

std::vector<TimedPose> read_poses(const std::filesystem::path& file, Repeats repeats) {
  return parse_poses(read_file(file, maximum_table_bytes), file.string(), repeats);
}

std::vector<TimedPose> parse_poses(std::string_view text, const std::string& name, Repeats repeats) {
  const bool is_tum = first_line(text).find(',') == std::string_view::npos;
  const NamedTable table = is_tum ? named_table(text, CellsParted::by_blanks, name, tum_columns)
                                  : named_table(text, CellsParted::by_commas, name, euroc_columns);
  const Form unnamed = is_tum ? tum : euroc,
             form = table.names.empty() ? unnamed : with_named_time(unnamed, table.names.front());
  std::vector<TimedPose> poses;
  poses.reserve(table.lines.size());
  for (const TableLine& line : table.lines) {
    const TimedPose pose = pose_in(line, form, name);
    const bool is_repeat = !poses.empty() && pose.t_ns == poses.back().t_ns;
    if (is_repeat && repeats == Repeats::skipped) continue;
    if (!poses.empty() && pose.t_ns <= poses.back().t_ns)
      fail_at_line(name, line.number, "times must increase from line to line");
    poses.push_back(pose);
  }
  if (poses.empty()) throw InputError(name + ": holds no pose");
  return poses;
}

Eigen::Isometry3d pose_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after,
                               double share) {
  const Eigen::Vector3d position = (1 - share) * before.translation() + share * after.translation();
  const Eigen::Quaterniond from(before.linear()), to(after.linear());
  return Eigen::Isometry3d(Eigen::Translation3d(position) * from.slerp(share, to));
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
  return pose_between(before->T_world_body, after->T_world_body, share);
}

}  // namespace understory
