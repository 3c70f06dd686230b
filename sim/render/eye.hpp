#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "perception/stereo_rig.hpp"

namespace understory {

/// One camera: its pose in the world and how it maps rays to pixels. OpenCV axes; the centre of the top left
/// pixel is (0, 0), so the picture reaches from -0.5 to width - 0.5.
struct Eye {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  double focal_px = 0;
  double center_x_px = 0;
  double center_y_px = 0;
  int width_px = 0;
  int height_px = 0;
};

constexpr double near_m = 0.1;   ///< the airframe's nose is behind the cameras
constexpr double far_m = 500.0;  ///< beyond the ground's rim

/// The two cameras of a rig on a body, left first. The right one is at baseline_m along x of the left one.
std::array<Eye, 2> eyes_of(const StereoRig& rig, const Eigen::Isometry3d& T_world_body);

/// A box in the world: the extent of a geom along its own axes.
struct GeomBox {
  Eigen::Isometry3d T_world_box = Eigen::Isometry3d::Identity();  ///< at its centre
  Eigen::Vector3d half_size = Eigen::Vector3d::Zero();            ///< m
};

/// False only where the camera sees no part of the box: a conservative test.
bool may_see(const Eye& eye, const GeomBox& box);
/// From a point to the nearest point of the box, m; 0 inside.
double distance_m(const Eigen::Vector3d& point_world, const GeomBox& box);

/// Metres along the optical axis from OpenGL's depth value in 0 .. 1.
inline double depth_of_gl(double value) { return near_m * far_m / (far_m - value * (far_m - near_m)); }

/// Depth and object at every pixel of the left camera's view, and depth in the right one's.
struct TrueView {
  cv::Mat
      depth_m;  ///< of the left eye, CV_32FC1: along the optical axis; the far plane's where there is nothing
  cv::Mat objects;  ///< CV_16UC1: the numbers of sim/scene/obstacle.hpp; nothing, too, where a far obstacle
                    ///< was culled
  cv::Mat right_depth_m;  ///< of the right eye
};

/// Gray image of one eye from rendered RGBA (rows bottom up, `stride_px` pixels each): green where something
/// was drawn, and elsewhere (alpha 0) the sky, bright at the horizon and a little darker overhead.
cv::Mat gray_with_sky(const std::uint8_t* rgba, int stride_px, const Eye& eye);
/// The same for people: BGR with a blue sky.
cv::Mat colour_with_sky(const std::uint8_t* rgba, const Eye& eye);

}  // namespace understory
