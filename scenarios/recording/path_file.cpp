#include "scenarios/recording/path_file.hpp"

#include <fmt/format.h>

#include <iterator>
#include <numbers>

#include "perception/io/text_table.hpp"
#include "scenarios/config/bad_input.hpp"

namespace understory {
namespace {

constexpr double fastest_mps = 100;
constexpr double widest_turn_rad = std::numbers::pi / 2;
constexpr std::int64_t closest_ns = 50'000'000;

bool is_trajectory(const std::vector<TableLine>& lines) {
  return !lines.empty() && !lines.front().cells.empty() && lines.front().cells.front() == "t_s";
}

/// As TUM's lines, each in its place, so that messages name the file's own.
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
  if (kept.size() > 1) kept.pop_back();  // rather a longer last piece than a short one
  kept.push_back(poses.back());
  return kept;
}

}  // namespace understory
