#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "perception/stereo_calibration.hpp"
#include "sim/scene/obstacle.hpp"

namespace google::protobuf {
class Timestamp;
}

namespace foxglove {
class CameraCalibration;
class CompressedImage;
class FrameTransform;
class PointCloud;
class Pose;
}  // namespace foxglove

/// A flight's data as Foxglove's messages. Times are simulated ones.
namespace understory {

void set_time(google::protobuf::Timestamp* timestamp, std::int64_t t_ns);
void set_pose(foxglove::Pose* to, const Eigen::Isometry3d& from);

foxglove::FrameTransform transform(const char* parent, const char* child, const Eigen::Isometry3d& pose,
                                   std::int64_t t_ns);

/// Points of three 32-bit floats each.
foxglove::PointCloud cloud(const char* frame, const std::vector<Eigen::Vector3d>& points, std::int64_t t_ns);

/// Points about every step_m round the obstacles, for viewers that draw no cylinders.
std::vector<Eigen::Vector3d> surface_points(const std::vector<Obstacle>& obstacles, double step_m);

foxglove::CameraCalibration calibration_of(const CalibratedRig& rig, bool is_left, std::int64_t t_ns);

/// The pose in the body of the camera that gives the images: a raw one is turned against the rectified pair.
Eigen::Isometry3d camera_pose(const CalibratedRig& rig, bool is_left);

/// As PNG.
foxglove::CompressedImage image_message(const cv::Mat& image, bool is_left, std::int64_t t_ns, bool exact);

}  // namespace understory
