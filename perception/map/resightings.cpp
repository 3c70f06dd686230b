#include "perception/map/resightings.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace understory {

Resightings::Resightings(const ResightingsConfig& config)
    : config_(config), clusters_(config.depths_m.size()) {
  std::sort(config_.depths_m.begin(), config_.depths_m.end(), std::greater<>());  // farthest first
}

std::size_t Resightings::nearest_depth(double depth_m) const {
  std::size_t best = 0;
  // Depths are apart by disparity, that is by their inverse.
  const auto apart = [&](std::size_t i) { return std::abs(1 / config_.depths_m[i] - 1 / depth_m); };
  for (std::size_t i = 1; i < config_.depths_m.size(); ++i)
    if (apart(i) < apart(best)) best = i;
  return best;
}

void Resightings::insert(const std::vector<StereoHit>& hits, const Eigen::Isometry3d& T_world_camera,
                         std::int64_t t_ns) {
  completed_.clear();
  if (!config_.enabled || config_.depths_m.size() < 2) return;
  for (const StereoHit& hit : hits) {
    const Eigen::Vector3d line_world = T_world_camera.linear() * hit.position_camera;
    const Eigen::Vector3d place_world = T_world_camera * hit.position_camera;
    gather(clusters_[nearest_depth(hit.position_camera.z())], place_world.head<2>(), t_ns,
           line_world.head<2>().normalized());
  }
  const auto since = [t_ns](const Cluster& cluster) {
    return 1e-9 * static_cast<double>(t_ns - cluster.last_ns);
  };
  for (std::size_t near = 1; near < clusters_.size(); ++near) {
    std::erase_if(clusters_[near], [&](const Cluster& cluster) {
      if (since(cluster) <= config_.settle_s) return false;
      // The last depth only completes; those between are far ones to their successors too, and stay.
      if (cluster.hits >= config_.minimum_hits && since(cluster) <= config_.settle_s + 0.02)
        match(cluster, clusters_[near - 1]);
      return near + 1 == clusters_.size() || since(cluster) > config_.oldest_s;
    });
  }
  std::erase_if(clusters_[0], [&](const Cluster& cluster) { return since(cluster) > config_.oldest_s; });
}

void Resightings::gather(std::vector<Cluster>& clusters, const Eigen::Vector2d& place_world,
                         std::int64_t t_ns, const Eigen::Vector2d& ahead_world) {
  Cluster* best = nullptr;
  double nearest_m = config_.cluster_m;
  for (Cluster& cluster : clusters) {
    const double apart_m = (cluster.centre_world() - place_world).norm();
    if (apart_m < nearest_m && 1e-9 * static_cast<double>(t_ns - cluster.last_ns) <= config_.settle_s) {
      nearest_m = apart_m;
      best = &cluster;
    }
  }
  if (best == nullptr) {
    best = &clusters.emplace_back();
    best->first_ns = t_ns;
  }
  best->sum_world += place_world;
  best->sum_since_s += 1e-9 * static_cast<double>(t_ns - best->first_ns);
  best->ahead_world = ahead_world;
  best->last_ns = t_ns;
  ++best->hits;
}

void Resightings::match(const Cluster& near, std::vector<Cluster>& far) {
  double best_m = config_.match_m, second_m = 1e9;
  const Cluster* found = nullptr;
  for (const Cluster& cluster : far) {
    const double elapsed_s = 1e-9 * static_cast<double>(near.mean_ns() - cluster.mean_ns());
    if (cluster.hits < config_.minimum_hits || elapsed_s <= 0 || elapsed_s > config_.oldest_s) continue;
    const double apart_m = (near.centre_world() - cluster.centre_world()).norm();
    if (apart_m < best_m) {
      second_m = found == nullptr ? second_m : best_m;
      best_m = apart_m;
      found = &cluster;
    } else {
      second_m = std::min(second_m, apart_m);
    }
  }
  if (found == nullptr || second_m < config_.rival * best_m) return;
  Resighting& resighting = completed_.emplace_back();
  resighting.t_ns = near.mean_ns();
  resighting.earlier_ns = found->mean_ns();
  resighting.discrepancy_world_m = near.centre_world() - found->centre_world();
  const Eigen::Vector2d along = near.ahead_world, across(-along.y(), along.x());
  resighting.covariance_m2 = config_.along_sigma_m * config_.along_sigma_m * along * along.transpose() +
                             config_.across_sigma_m * config_.across_sigma_m * across * across.transpose();
}

}  // namespace understory
