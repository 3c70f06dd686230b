#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

namespace understory::fuzz {

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "expected %s\n", what);
  std::abort();
}

/// Parses; aborts where that ends in anything but a result that `check` takes or one line of complaint that
/// begins with `name`.
template <typename Parse, typename Check>
void expect_result_or_complaint(Parse&& parse, Check&& check, std::string_view name = "fuzzed") {
  try {
    check(parse());
  } catch (const std::runtime_error& error) {
    const std::string_view line = error.what();
    require(line.starts_with(name) && line.find('\n') == std::string_view::npos, "one line naming the file");
  }
}

/// What every reader of poses promises: times increase, and between any two poses there is a rigid one.
inline void check_poses(const std::vector<TimedPose>& poses) {
  require(!poses.empty() && poses.front().t_ns >= 0, "a first pose, its time from 0");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    require(i == 0 || poses[i].t_ns > poses[i - 1].t_ns, "times that increase");
    const std::int64_t next_ns = poses[i + 1 < poses.size() ? i + 1 : i].t_ns;
    const auto pose = pose_at(poses, poses[i].t_ns + (next_ns - poses[i].t_ns) / 2);
    require(pose && pose->matrix().allFinite(), "a pose half way");
    const Eigen::Matrix3d R = pose->linear();
    require((R.transpose() * R).isIdentity(1e-6) && R.determinant() > 0, "a rotation half way");
  }
}

}  // namespace understory::fuzz
