#include "scenarios/evaluation/published_evaluations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <numeric>

namespace understory {
namespace {

constexpr double crop_m = 0.5;           // evaluation 1: StereoBM's points about the detection depth
constexpr double minimum_range_m = 1.5;  // evaluation 2 ignores nearer points
constexpr double near_m = 5.0;           // evaluation 3 asks for points nearer than this
constexpr double nothing_there_m = 10;   // what counts where there is nothing to compare with

Eigen::Vector3d point_at(const StereoRig& rig, double column_px, double row_px, double depth_m) {
  return {(column_px - rig.center_left_x_px) * depth_m / rig.focal_px,
          (row_px - rig.center_y_px) * depth_m / rig.focal_px, depth_m};
}

bool in_view(const StereoRig& rig, const Eigen::Vector3d& point_camera) {
  if (point_camera.z() < minimum_range_m) return false;
  const double u = rig.focal_px * point_camera.x() / point_camera.z() + rig.center_left_x_px;
  const double v = rig.focal_px * point_camera.y() / point_camera.z() + rig.center_y_px;
  return u >= 0 && u <= rig.width_px - 1 && v >= 0 && v <= rig.height_px - 1;
}

/// StereoBM's points between two depths; `truth`: only those of pixels that it, where it is known, gives to
/// an obstacle.
std::vector<Eigen::Vector3d> points_between(const StereoRig& rig, const cv::Mat& depth_m, double minimum_m,
                                            double maximum_m, const TrueImages* truth = nullptr) {
  std::vector<Eigen::Vector3d> points;
  for (int v = 0; v < depth_m.rows; ++v) {
    const auto* row = depth_m.ptr<float>(v);
    const auto* object =
        truth != nullptr && !truth->objects.empty() ? truth->objects.ptr<std::uint16_t>(v) : nullptr;
    for (int u = 0; u < depth_m.cols; ++u) {
      if (row[u] <= 0 || row[u] < minimum_m || row[u] > maximum_m) continue;
      if (object != nullptr && !truth->is_obstacle(object[u])) continue;
      points.push_back(point_at(rig, u, v, row[u]));
    }
  }
  return points;
}

/// No StereoBM point counts as 10 m, and so does none remembered.
double or_far(double distance_m) { return std::isfinite(distance_m) ? distance_m : nothing_there_m; }

/// What nanoflann asks of a cloud of points.
struct Cloud {
  const std::vector<Eigen::Vector3d>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using PointTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3>;

}  // namespace

void DistanceHistogram::add(double distance_m) {
  if (!std::isfinite(distance_m)) {
    ++no_match;
    return;
  }
  const double bin = std::ceil(distance_m / bin_m) - 1;
  ++bins[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bin_count - 1)))];
}

void DistanceHistogram::add(const DistanceHistogram& other) {
  for (std::size_t i = 0; i < bin_count; ++i) bins[i] += other.bins[i];
  no_match += other.no_match;
}

std::int64_t DistanceHistogram::total() const { return std::accumulate(bins.begin(), bins.end(), no_match); }

double DistanceHistogram::share_within(double limit_m) const {
  const auto within = std::min<std::ptrdiff_t>(std::lround(limit_m / bin_m), bin_count);
  const std::int64_t count = std::accumulate(bins.begin(), bins.begin() + within, std::int64_t{0});
  return total() > 0 ? static_cast<double>(count) / static_cast<double>(total()) : 0;
}

double DistanceHistogram::share_without_match() const {
  return total() > 0 ? static_cast<double>(no_match) / static_cast<double>(total()) : 0;
}

std::vector<double> nearest_distances_m(const std::vector<Eigen::Vector3d>& from,
                                        const std::vector<Eigen::Vector3d>& to) {
  std::vector<double> distances_m(from.size(), std::numeric_limits<double>::infinity());
  if (to.empty() || from.empty()) return distances_m;
  const Cloud cloud{to};
  PointTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  tree.buildIndex();
  for (std::size_t i = 0; i < from.size(); ++i) {
    unsigned int index = 0;
    double squared_m2 = 0;
    tree.knnSearch(from[i].data(), 1, &index, &squared_m2);
    distances_m[i] = std::sqrt(squared_m2);
  }
  return distances_m;
}

void PublishedScores::add(const PublishedScores& other) {
  single_frame.add(other.single_frame);
  false_positives.add(other.false_positives);
  false_negatives.add(other.false_negatives);
}

PublishedEvaluations::PublishedEvaluations(const StereoRig& rig, const DetectionGrid& grid,
                                           const LocalMapConfig& map)
    : rig_(rig), grid_(grid), map_(map) {}

void PublishedEvaluations::remember(const EvaluationFrame& frame, const std::vector<StereoHit>& hits) {
  if (frame.T_odometry_camera) map_.insert(hits, *frame.T_odometry_camera, frame.pair.t_ns);
}

void PublishedEvaluations::compare(const EvaluationFrame& frame, const std::vector<StereoHit>& hits,
                                   const cv::Mat& depth_m) {
  const double detection_m = grid_.depths[0].depth_m;
  std::vector<Eigen::Vector3d> hit_points;
  for (const StereoHit& hit : hits) hit_points.push_back(hit.position_camera);
  for (const double distance_m : nearest_distances_m(
           hit_points, points_between(rig_, depth_m, detection_m - crop_m, detection_m + crop_m)))
    scores_.single_frame.add(distance_m);

  if (!frame.T_odometry_camera) return;
  const Eigen::Isometry3d T_camera_odometry = frame.T_odometry_camera->inverse();
  std::vector<Eigen::Vector3d> remembered, remembered_in_view;
  for (const ObstaclePoint& point : map_.points()) {
    remembered.push_back(T_camera_odometry * point.position_world);
    if (in_view(rig_, remembered.back())) remembered_in_view.push_back(remembered.back());
  }
  constexpr double everything_m = std::numeric_limits<double>::max();
  for (const double distance_m :
       nearest_distances_m(remembered_in_view, points_between(rig_, depth_m, minimum_range_m, everything_m)))
    scores_.false_positives.add(or_far(distance_m));
  for (const double distance_m :
       nearest_distances_m(points_between(rig_, depth_m, 0, near_m, &frame.truth), remembered))
    scores_.false_negatives.add(or_far(distance_m));
}

}  // namespace understory
