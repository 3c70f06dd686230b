#include "sim/cameras/pose_history.hpp"

#include <algorithm>
#include <stdexcept>

namespace understory {

void PoseHistory::observe(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns) {
  if (!moments_.empty() && t_ns <= moments_.back().t_ns) return;
  moments_.push_back({t_ns, T_world_body});
  while (moments_.size() > 1 && moments_[1].t_ns <= t_ns - kept_ns_) moments_.pop_front();
}

Eigen::Isometry3d PoseHistory::at(std::int64_t t_ns) const {
  if (moments_.empty()) throw std::logic_error("no pose was observed before it is asked for");
  const auto later = std::lower_bound(moments_.begin(), moments_.end(), t_ns,
                                      [](const Moment& moment, std::int64_t t) { return moment.t_ns < t; });
  if (later == moments_.end()) return moments_.back().T_world_body;
  if (later == moments_.begin() || later->t_ns == t_ns) return later->T_world_body;
  const Moment& earlier = *std::prev(later);
  const double part =
      static_cast<double>(t_ns - earlier.t_ns) / static_cast<double>(later->t_ns - earlier.t_ns);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() =
      (1 - part) * earlier.T_world_body.translation() + part * later->T_world_body.translation();
  pose.linear() = Eigen::Quaterniond(earlier.T_world_body.linear())
                      .slerp(part, Eigen::Quaterniond(later->T_world_body.linear()))
                      .toRotationMatrix();
  return pose;
}

}  // namespace understory
