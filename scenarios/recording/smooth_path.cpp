#include "scenarios/recording/smooth_path.hpp"

#include <algorithm>

#include "scenarios/output/require.hpp"

namespace understory {

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

/// The tridiagonal system that makes slopes meet at every knot, with none at the ends, by elimination from
/// the front.
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

}  // namespace understory
