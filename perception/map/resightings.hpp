#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "perception/perception_config.hpp"
#include "perception/stereo_hit.hpp"

namespace understory {

/// One obstacle, located twice by the same estimate.
struct Resighting {
  std::int64_t t_ns = 0;                                          ///< mean moment of the nearer sighting
  std::int64_t earlier_ns = 0;                                    ///< and of the farther
  Eigen::Vector2d discrepancy_world_m = Eigen::Vector2d::Zero();  ///< nearer place less farther, horizontal
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
};

/// The displacement measurement that a pushbroom with several depths gives (docs/sources.md [15]): an
/// obstacle crosses the farther depth, then a nearer one; the difference of the two places is the drift of
/// the estimate in between. Trunks and posts are upright, so only the horizontal part counts. Hits of one
/// depth are gathered in clusters, whose mean place over the crossing leaves little of the depth interval.
class Resightings {
 public:
  /// Without at least two depths there are no results. A hit belongs to the nearest depth.
  explicit Resightings(const ResightingsConfig& config);

  /// One frame's hits. The pose is that of the left camera at the image's moment.
  void insert(const std::vector<StereoHit>& hits, const Eigen::Isometry3d& T_world_camera, std::int64_t t_ns);
  /// The resightings completed by the last insert().
  const std::vector<Resighting>& completed() const { return completed_; }

 private:
  struct Cluster {
    Eigen::Vector2d sum_world = Eigen::Vector2d::Zero();
    Eigen::Vector2d ahead_world = Eigen::Vector2d::UnitX();  ///< line of sight when last seen, level
    double sum_since_s = 0;
    std::int64_t first_ns = 0;
    std::int64_t last_ns = 0;
    int hits = 0;
    Eigen::Vector2d centre_world() const { return sum_world / hits; }
    std::int64_t mean_ns() const { return first_ns + static_cast<std::int64_t>(1e9 * sum_since_s / hits); }
  };
  std::size_t nearest_depth(double depth_m) const;
  void gather(std::vector<Cluster>& clusters, const Eigen::Vector2d& place_world, std::int64_t t_ns,
              const Eigen::Vector2d& ahead_world);
  void match(const Cluster& near, std::vector<Cluster>& far);

  ResightingsConfig config_;
  std::vector<std::vector<Cluster>> clusters_;  ///< of each depth
  std::vector<Resighting> completed_;
};

}  // namespace understory
