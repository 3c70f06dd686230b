#include "scenarios/recording/carried_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numbers>

#include "perception/io/text_table.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/output/require.hpp"

namespace understory {
namespace {

constexpr double fastest_mps = 100;
constexpr double widest_turn_rad = std::numbers::pi / 2;
constexpr std::int64_t closest_ns = 50'000'000;

bool is_trajectory(const std::vector<TableLine>& lines) {
  return !lines.empty() && !lines.front().cells.empty() && lines.front().cells.front() == "t_s";
}

/// As lines of TUM's form with the file's line numbers, for messages.
std::string as_tum(const std::vector<TableLine>& lines, const std::string& name) {
  std::string text;
  int number = 1;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto& cell = lines[i].cells;
    if (cell.size() < 8)
      fail_at_line(name, lines[i].number,
                   "expected t_s,x_m,y_m,z_m,qw,qx,qy,qz and more, as a flight writes them");
    for (; number < lines[i].number; ++number) text += '\n';
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {}", cell[0], cell[1], cell[2], cell[3],
                   cell[5], cell[6], cell[7], cell[4]);
  }
  return text;
}

std::vector<TimedPose> poses_in(const std::filesystem::path& file) {
  const std::string text = text_of(file);
  const std::vector<TableLine> lines = table_lines(text, CellsParted::by_commas);
  return is_trajectory(lines) ? parse_tum_poses(as_tum(lines, file.string()), file.string())
                              : read_poses(file);
}

}  // namespace

std::vector<TimedPose> read_path(const std::filesystem::path& file) {
  const std::vector<TimedPose> poses = bad_input_if_refused([&] { return poses_in(file); });
  if (poses.size() < 2)
    throw ScenarioError(
        fmt::format("{}: expected at least two poses to go between, found one", file.string()));
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Isometry3d step = poses[i - 1].T_world_body.inverse() * poses[i].T_world_body;
    const double step_s = static_cast<double>(poses[i].t_ns - poses[i - 1].t_ns) * 1e-9;
    const auto fail_unless = [&](bool holds, const char* what) {
      if (!holds)
        throw ScenarioError(fmt::format("{}: expected {} from pose {} to the next", file.string(), what, i));
    };
    fail_unless(step.translation().norm() <= fastest_mps * step_s, "at most 100 m/s");
    fail_unless(Eigen::AngleAxisd(step.linear()).angle() <= widest_turn_rad, "at most a quarter turn");
  }
  return poses;
}

std::vector<TimedPose> thinned(const std::vector<TimedPose>& poses) {
  std::vector<TimedPose> kept;
  for (const TimedPose& pose : poses)
    if (kept.empty() || pose.t_ns - kept.back().t_ns >= closest_ns) kept.push_back(pose);
  if (poses.size() < 2 || kept.back().t_ns == poses.back().t_ns) return kept;
  if (kept.size() > 1) kept.pop_back();  // a longer last piece instead of a short one
  kept.push_back(poses.back());
  return kept;
}

SmoothPath::SmoothPath(const std::vector<TimedPose>& poses) {
  require(poses.size() >= 2, "a path has at least two poses");
  for (const TimedPose& pose : poses) {
    Channels value;
    const Eigen::Quaterniond q(pose.T_world_body.linear());
    value << pose.T_world_body.translation(), q.w(), q.x(), q.y(), q.z();
    if (!values_.empty() && value.tail<4>().dot(values_.back().tail<4>()) < 0) value.tail<4>() *= -1;
    values_.push_back(value);
    times_s_.push_back(static_cast<double>(pose.t_ns - poses.front().t_ns) * 1e-9);
  }
  solve_second_derivatives();
}

/// Solves the tridiagonal system of a natural cubic spline by forward elimination.
void SmoothPath::solve_second_derivatives() {
  const std::size_t count = values_.size();
  second_derivatives_.assign(count, Channels::Zero());
  std::vector<double> shares(count, 0);  // of the next knot's in this one's
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double before_s = times_s_[i] - times_s_[i - 1], after_s = times_s_[i + 1] - times_s_[i];
    const Channels slopes_apart =
        (values_[i + 1] - values_[i]) / after_s - (values_[i] - values_[i - 1]) / before_s;
    const double diagonal_s = 2 * (before_s + after_s) - before_s * shares[i - 1];
    shares[i] = after_s / diagonal_s;
    second_derivatives_[i] = (6 * slopes_apart - before_s * second_derivatives_[i - 1]) / diagonal_s;
  }
  for (std::size_t i = count - 2; i > 0; --i)
    second_derivatives_[i] -= shares[i] * second_derivatives_[i + 1];
}

Eigen::Isometry3d SmoothPath::at(double t_s) const {
  const auto later = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, t_s);
  const auto i = static_cast<std::size_t>(later - times_s_.begin());
  const double h_s = times_s_[i] - times_s_[i - 1];
  const double a = (times_s_[i] - t_s) / h_s, b = 1 - a;
  const Channels value =
      a * values_[i - 1] + b * values_[i] +
      h_s * h_s / 6 *
          ((a * a * a - a) * second_derivatives_[i - 1] + (b * b * b - b) * second_derivatives_[i]);
  const Eigen::Quaterniond q(value[3], value[4], value[5], value[6]);
  return Eigen::Translation3d(value.head<3>()) * q.normalized();
}

Truth carried_truth(const CarriedPose& pose_at, std::int64_t t_ns, double gravity_mps2) {
  constexpr double h_s = 1e-4;
  const double t_s = static_cast<double>(t_ns) * 1e-9;
  const Eigen::Isometry3d before = pose_at(t_s - h_s), now = pose_at(t_s), after = pose_at(t_s + h_s);
  Truth truth;
  truth.t_ns = t_ns;
  truth.T_world_body = now;
  truth.velocity_world_mps = (after.translation() - before.translation()) / (2 * h_s);
  const Eigen::AngleAxisd turned(Eigen::Matrix3d(before.linear().transpose() * after.linear()));
  truth.angular_rate_body_radps = turned.angle() * turned.axis() / (2 * h_s);
  const Eigen::Vector3d acceleration_world_mps2 =
      (after.translation() - 2 * now.translation() + before.translation()) / (h_s * h_s);
  truth.specific_force_body_mps2 =
      now.linear().transpose() * (acceleration_world_mps2 + gravity_mps2 * Eigen::Vector3d::UnitZ());
  return truth;
}

}  // namespace understory
