#include "scenarios/evaluation/published_evaluations.hpp"

#include <cmath>
#include <limits>

#include "perception/io/rig_file.hpp"
#include "scenarios/evaluation/nearest_distances.hpp"

namespace understory {
namespace {

constexpr double crop_m = 0.5;           // evaluation 1: StereoBM's points about the detection depth
constexpr double minimum_range_m = 1.5;  // evaluation 2 ignores nearer points
constexpr double near_m = 5.0;           // evaluation 3 asks for points nearer than this
constexpr double nothing_there_m = 10;   // what counts where there is nothing to compare with
constexpr int first_obstacle = 2;

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

/// StereoBM's points between two depths; `on_obstacles`: those of pixels that the truth, where it is known,
/// gives to an obstacle.
std::vector<Eigen::Vector3d> points_between(const StereoRig& rig, const cv::Mat& depth_m, double minimum_m,
                                            double maximum_m, const cv::Mat* on_obstacles = nullptr) {
  std::vector<Eigen::Vector3d> points;
  for (int v = 0; v < depth_m.rows; ++v) {
    const auto* row = depth_m.ptr<float>(v);
    const auto* object =
        on_obstacles != nullptr && !on_obstacles->empty() ? on_obstacles->ptr<std::uint16_t>(v) : nullptr;
    for (int u = 0; u < depth_m.cols; ++u) {
      if (row[u] <= 0 || row[u] < minimum_m || row[u] > maximum_m) continue;
      if (object != nullptr && object[u] < first_obstacle) continue;
      points.push_back(point_at(rig, u, v, row[u]));
    }
  }
  return points;
}

/// No StereoBM point counts as 10 m, and so does none remembered.
double or_far(double distance_m) { return std::isfinite(distance_m) ? distance_m : nothing_there_m; }

}  // namespace

void PublishedScores::add(const PublishedScores& other) {
  single_frame.add(other.single_frame);
  false_positives.add(other.false_positives);
  false_negatives.add(other.false_negatives);
}

PublishedEvaluations::PublishedEvaluations(const StereoRig& rig, const DetectionGrid& grid,
                                           const LocalMapConfig& map)
    : rig_(rig), grid_(grid), map_(map) {}

void PublishedEvaluations::remember(const EvaluationFrame& frame, const std::vector<StereoHit>& hits) {
  if (!frame.T_odometry_camera) return;
  const Eigen::Isometry3d& T_odometry_camera = *frame.T_odometry_camera;
  if (T_odometry_camera_)
    distance_flown_m_ += (T_odometry_camera.translation() - T_odometry_camera_->translation()).norm();
  T_odometry_camera_ = T_odometry_camera;
  map_.insert(hits, T_odometry_camera, frame.pair.t_ns, distance_flown_m_);
  // The axes of a body whose x is the camera's axis: recorded bodies' own point anywhere (EuRoC's x is up).
  const Eigen::Isometry3d T_camera_looking = T_body_camera_of(Eigen::Vector3d::Zero(), 0).inverse();
  map_.forget_passed(T_odometry_camera * T_camera_looking, frame.pair.t_ns);
}

void PublishedEvaluations::compare(const EvaluationFrame& frame, const std::vector<StereoHit>& hits,
                                   const cv::Mat& depth_m) {
  const double detection_m = grid_.depths[0].depth_m;
  std::vector<Eigen::Vector3d> hit_points;
  for (const StereoHit& hit : hits) hit_points.push_back(hit.position_camera);
  for (const double distance_m : nearest_distances_m(
           hit_points, points_between(rig_, depth_m, detection_m - crop_m, detection_m + crop_m)))
    scores_.single_frame.add(distance_m);

  if (!T_odometry_camera_ || !frame.T_odometry_camera) return;
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
       nearest_distances_m(points_between(rig_, depth_m, 0, near_m, &frame.truth.objects), remembered))
    scores_.false_negatives.add(or_far(distance_m));
}

}  // namespace understory
