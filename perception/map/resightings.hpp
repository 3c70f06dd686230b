#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "perception/stereo_hit.hpp"

namespace understory {

/// How sightings at two depths become one displacement.
struct ResightingsConfig {
  bool enabled = false;
  std::vector<double> depths_m;  ///< that the detector looks at; the composition knows them, no key says them
  /// Level distance from a cluster's centre within which hits of one depth join it. While a trunk crosses the
  /// depth interval of a pixel (1.6 m at 10 m), its places smear over as much in the odometry frame, and by
  /// what a wind that is not yet known carries meanwhile.
  double cluster_m = 2.0;
  int minimum_hits = 8;    ///< a cluster of fewer is left alone
  double settle_s = 0.04;  ///< a nearer cluster without a hit for as long is complete
  /// Level distance between the two places of one obstacle, at most: an unknown wind of 5 m/s over the half
  /// second between 10 and 5 m.
  double match_m = 2.5;
  double rival = 1.5;     ///< any other far cluster must be this many times as distant
  double oldest_s = 0.9;  ///< between the two sightings, at most
  /// Of the discrepancy, along the line of sight: what remains of a pixel's depth interval once its crossing
  /// is averaged, and of where a trunk's face lies.
  double along_sigma_m = 0.25;
  double across_sigma_m = 0.10;  ///< and across it: blocks of 5 pixels at 10 m are 0.13 m
};

template <typename Visitor>
void visit_fields(Visitor& visit, ResightingsConfig& config) {
  visit("enabled", config.enabled);
  visit("cluster_m", config.cluster_m, 0.05, 10.0);
  visit("minimum_hits", config.minimum_hits, 1, 10000);
  visit("settle_s", config.settle_s, 0.0, 1.0);
  visit("match_m", config.match_m, 0.05, 20.0);
  visit("rival", config.rival, 1.0, 100.0);
  visit("oldest_s", config.oldest_s, 0.05, 10.0);
  visit("along_sigma_m", config.along_sigma_m, 0.001, 10.0);
  visit("across_sigma_m", config.across_sigma_m, 0.001, 10.0);
}

/// One obstacle, placed twice by the same estimate.
struct Resighting {
  std::int64_t t_ns = 0;                                          ///< mean moment of the nearer sighting
  std::int64_t earlier_ns = 0;                                    ///< and of the farther
  Eigen::Vector2d discrepancy_world_m = Eigen::Vector2d::Zero();  ///< nearer place less farther, level
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
};

/// The displacement measurement that a pushbroom with several depths gives (docs/sources.md [15]): an
/// obstacle crosses the farther depth, then a nearer one; by as much as the second place misses the first,
/// the estimate has drifted meanwhile. Trunks and posts stand upright, so only the level part counts. Hits of
/// one depth are gathered in clusters, whose mean place over the crossing leaves little of the depth
/// interval.
class Resightings {
 public:
  /// Nothing comes out with fewer than two depths. A hit belongs to the nearest.
  explicit Resightings(const ResightingsConfig& config);

  /// One frame's hits. The pose is that of the left camera at the image's moment.
  void insert(const std::vector<StereoHit>& hits, const Eigen::Isometry3d& T_world_camera, std::int64_t t_ns);
  /// What was completed by the last insert.
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
