#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>

namespace understory {

/// The body's recent poses, for images with an exposure time.
class PoseHistory {
 public:
  explicit PoseHistory(std::int64_t kept_ns) : kept_ns_(kept_ns) {}
  /// Times strictly increasing; a moment already known is left alone.
  void observe(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns);
  /// Between two observed moments the position linearly, the attitude along the shorter arc; exactly the
  /// observed pose at an observed moment; the oldest pose before all, the newest after all. Asks for one.
  Eigen::Isometry3d at(std::int64_t t_ns) const;

 private:
  struct Moment {
    std::int64_t t_ns;
    Eigen::Isometry3d T_world_body;
  };
  std::int64_t kept_ns_;
  std::deque<Moment> moments_;
};

}  // namespace understory
