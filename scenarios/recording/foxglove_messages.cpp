#include "scenarios/recording/foxglove_messages.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core/matx.hpp>

#include "perception/io/calibration/write_calibration.hpp"
#include "perception/io/picture_codecs.hpp"
#include "perception/io/png_codec.hpp"
#include "scenarios/recording/foxglove.pb.h"

namespace understory {
namespace {

void set_vector(foxglove::Vector3* to, const Eigen::Vector3d& from) {
  to->set_x(from.x());
  to->set_y(from.y());
  to->set_z(from.z());
}

void set_turn(foxglove::Quaternion* to, const Eigen::Isometry3d& from) {
  const Eigen::Quaterniond turn(from.linear());
  to->set_x(turn.x());
  to->set_y(turn.y());
  to->set_z(turn.z());
  to->set_w(turn.w());
}

/// A wall's two faces.
void add_wall_points(const Obstacle& wall, double step_m, std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d extent = wall.to_world - wall.from_world;
  const Eigen::Vector3d side(extent.x(), extent.y(), 0), up(0, 0, extent.z());
  const Eigen::Vector3d thick = wall.radius_m * Eigen::Vector3d::UnitZ().cross(side).normalized();
  // A facade of 60 m x 20 m would have a quarter of a million points 0.1 m apart.
  const double apart_m = std::max(step_m, std::sqrt(side.norm() * std::abs(extent.z()) / 5000));
  const auto columns = static_cast<int>(std::ceil(side.norm() / apart_m)),
             rows = static_cast<int>(std::ceil(std::abs(extent.z()) / apart_m));
  for (int column = 0; column <= columns; ++column)
    for (int row = 0; row <= rows; ++row) {
      const Eigen::Vector3d middle = wall.from_world +
                                     static_cast<double>(column) / std::max(1, columns) * side +
                                     static_cast<double>(row) / std::max(1, rows) * up;
      points.push_back(middle + thick);
      points.push_back(middle - thick);
    }
}

/// A grid on each of the six faces.
void add_box_points(const Obstacle& box, double step_m, std::vector<Eigen::Vector3d>& points) {
  const Eigen::Isometry3d T_world_box = box.T_world_box();
  const Eigen::Vector3d& half = box.half_size_m;
  const double apart_m = std::max(step_m, std::sqrt(half.maxCoeff() * half.sum() / 2000));
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int columns = std::max(1, static_cast<int>(std::ceil(2 * half[u] / apart_m))),
              rows = std::max(1, static_cast<int>(std::ceil(2 * half[v] / apart_m)));
    for (const double side : {-1.0, 1.0})
      for (int column = 0; column <= columns; ++column)
        for (int row = 0; row <= rows; ++row) {
          Eigen::Vector3d point;
          point[axis] = side * half[axis];
          point[u] = (2.0 * column / columns - 1) * half[u];
          point[v] = (2.0 * row / rows - 1) * half[v];
          points.push_back(T_world_box * point);
        }
  }
}

/// Evenly by the golden angle.
void add_ball_points(const Obstacle& ball, double step_m, std::vector<Eigen::Vector3d>& points) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const int count =
      std::clamp(static_cast<int>(4 * std::numbers::pi * std::pow(ball.radius_m / step_m, 2)), 20, 5000);
  for (int i = 0; i < count; ++i) {
    const double z = 1 - 2 * (i + 0.5) / count, out = std::sqrt(1 - z * z);
    points.push_back(ball.from_world + ball.radius_m * Eigen::Vector3d(out * std::cos(golden * i),
                                                                       out * std::sin(golden * i), z));
  }
}

}  // namespace

void set_time(google::protobuf::Timestamp* timestamp, std::int64_t t_ns) {
  timestamp->set_seconds(t_ns / 1'000'000'000);
  timestamp->set_nanos(static_cast<std::int32_t>(t_ns % 1'000'000'000));
}

void set_pose(foxglove::Pose* to, const Eigen::Isometry3d& from) {
  set_vector(to->mutable_position(), from.translation());
  set_turn(to->mutable_orientation(), from);
}

foxglove::FrameTransform transform(const char* parent, const char* child, const Eigen::Isometry3d& pose,
                                   std::int64_t t_ns) {
  foxglove::FrameTransform message;
  set_time(message.mutable_timestamp(), t_ns);
  message.set_parent_frame_id(parent);
  message.set_child_frame_id(child);
  set_vector(message.mutable_translation(), pose.translation());
  set_turn(message.mutable_rotation(), pose);
  return message;
}

foxglove::PointCloud cloud(const char* frame, const std::vector<Eigen::Vector3d>& points, std::int64_t t_ns) {
  foxglove::PointCloud message;
  set_time(message.mutable_timestamp(), t_ns);
  message.set_frame_id(frame);
  set_pose(message.mutable_pose(), Eigen::Isometry3d::Identity());
  message.set_point_stride(3 * sizeof(float));
  std::uint32_t offset = 0;
  for (const char* const name : {"x", "y", "z"}) {
    foxglove::PackedElementField* field = message.add_fields();
    field->set_name(name);
    field->set_offset(offset);
    field->set_type(foxglove::PackedElementField::FLOAT32);
    offset += sizeof(float);
  }
  std::string& data = *message.mutable_data();
  for (const Eigen::Vector3d& point : points)
    for (const auto coordinate : Eigen::Vector3f(point.cast<float>()))
      data.append(reinterpret_cast<const char*>(&coordinate), sizeof coordinate);
  return message;
}

std::vector<Eigen::Vector3d> surface_points(const std::vector<Obstacle>& obstacles, double step_m) {
  std::vector<Eigen::Vector3d> points;
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.kind == ObstacleKind::wall) {
      add_wall_points(obstacle, step_m, points);
      continue;
    }
    if (obstacle.kind == ObstacleKind::box) {
      add_box_points(obstacle, step_m, points);
      continue;
    }
    if (obstacle.kind == ObstacleKind::sphere) {
      add_ball_points(obstacle, step_m, points);
      continue;
    }
    const Eigen::Vector3d along = obstacle.to_world - obstacle.from_world;
    const auto rings = static_cast<int>(std::ceil(along.norm() / step_m));
    const int sides = std::max(6, static_cast<int>(2 * std::numbers::pi * obstacle.radius_m / step_m));
    const Eigen::Vector3d axis = along.normalized();
    const Eigen::Vector3d side = axis.unitOrthogonal(), other = axis.cross(side);
    for (int ring = 0; ring <= rings; ++ring)
      for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        points.push_back(obstacle.from_world + static_cast<double>(ring) / std::max(1, rings) * along +
                         obstacle.radius_m * (std::cos(angle) * side + std::sin(angle) * other));
      }
  }
  return points;
}

foxglove::CameraCalibration calibration_of(const CalibratedRig& rig, bool is_left, std::int64_t t_ns) {
  foxglove::CameraCalibration message;
  set_time(message.mutable_timestamp(), t_ns);
  message.set_frame_id(is_left ? "left_camera" : "right_camera");
  message.set_width(static_cast<std::uint32_t>(rig.rig.width_px));
  message.set_height(static_cast<std::uint32_t>(rig.rig.height_px));
  const auto put = [](const auto& matrix, google::protobuf::RepeatedField<double>* to) {
    for (const double value : matrix.val) to->Add(value);
  };
  const StereoCalibration cameras = cameras_of(rig);
  const CameraCalibration& camera = is_left ? cameras.left : cameras.right;
  if (rig.calibration) {
    message.set_distortion_model(camera.lens == LensModel::equidistant ? "kannala_brandt"
                                 : camera.distortion.size() > 5        ? "rational_polynomial"
                                                                       : "plumb_bob");
    for (const double number : camera.distortion) message.add_d(number);
  }
  put(camera.camera_matrix, message.mutable_k());
  put(camera.rectification, message.mutable_r());
  put(camera.projection, message.mutable_p());
  return message;
}

Eigen::Isometry3d camera_pose(const CalibratedRig& rig, bool is_left) {
  Eigen::Isometry3d pose =
      rig.rig.T_body_camera * Eigen::Translation3d(is_left ? 0 : rig.rig.baseline_m, 0, 0);
  if (!rig.calibration) return pose;
  const cv::Matx33d& turn = (is_left ? rig.calibration->left : rig.calibration->right).rectification;
  pose.linear() *= Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(turn.val);
  return pose;
}

foxglove::CompressedImage image_message(const cv::Mat& image, bool is_left, std::int64_t t_ns, bool exact) {
  foxglove::CompressedImage message;
  set_time(message.mutable_timestamp(), t_ns);
  message.set_frame_id(is_left ? "left_camera" : "right_camera");
  constexpr int quality = 40;  // of 100: a noisy picture of 376x240 in 10 kB
  message.set_format(exact ? "png" : "jpeg");
  const std::vector<unsigned char> bytes =
      exact ? encode_png(image) : picture_codecs().encode_jpeg(image, quality);
  message.set_data(bytes.data(), bytes.size());
  return message;
}

}  // namespace understory
