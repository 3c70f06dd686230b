#include "sim/cameras/stereo_optics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace understory {
namespace {

/// Pixels of the rendered view for one of the raw image at its middle. Rendering does not smooth. With more
/// pixels than the camera, bilinear sampling loses less contrast.
constexpr double oversampling = 1.25;
/// Rays more than 63 degrees off the axis are left out, because a pinhole view would need too many pixels for
/// them.
constexpr double steepest = 2.0;

/// The angle to the axis (its tangent) up to which the radial distortion grows outward. Beyond, its
/// polynomials fold back onto pixels that already have a ray; no ray belongs there.
double fold_of(const CameraCalibration& camera) {
  std::vector<double> k = camera.distortion;  // k1 k2 p1 p2 k3 k4 k5 k6, or k1 k2 k3 k4
  k.resize(8, 0.0);
  const auto bent = [&](double r) {
    const bool is_equidistant = camera.lens == LensModel::equidistant;
    const double angle = is_equidistant ? std::atan(r) : r, q = angle * angle;
    if (is_equidistant) return angle * (1 + q * (k[0] + q * (k[1] + q * (k[2] + q * k[3]))));
    return r * (1 + q * (k[0] + q * (k[1] + q * k[4]))) / (1 + q * (k[5] + q * (k[6] + q * k[7])));
  };
  double before = 0;
  for (double r = 0.001; r < steepest; r += 0.001) {
    const double here = bent(r);
    if (here <= before) return r;
    before = here;
  }
  return steepest;
}

/// Inverts the distortion by iteration and keeps rays that distort back to the same pixel.
cv::Mat rays_of(const CameraCalibration& camera, const cv::Size& size) {
  std::vector<cv::Point2d> pixels, rays, again;
  for (int row = 0; row < size.height; ++row)
    for (int column = 0; column < size.width; ++column) pixels.emplace_back(column, row);
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-8);
  if (camera.lens == LensModel::equidistant) {
    cv::fisheye::undistortPoints(pixels, rays, camera.camera_matrix, camera.distortion, cv::noArray(),
                                 cv::noArray(), until);
    cv::fisheye::distortPoints(rays, again, camera.camera_matrix, camera.distortion);
  } else {
    cv::undistortPoints(pixels, rays, camera.camera_matrix, camera.distortion, cv::noArray(), cv::noArray(),
                        until);
    std::vector<cv::Point3d> points;
    for (const cv::Point2d& ray : rays) points.emplace_back(ray.x, ray.y, 1);
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), camera.camera_matrix, camera.distortion, again);
  }
  const double fold = fold_of(camera), none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool holds = cv::norm(again[i] - pixels[i]) < 0.01 && cv::norm(rays[i]) < fold;
    if (!holds) rays[i] = {none, none};
  }
  return cv::Mat(rays, true).reshape(2, size.height);
}

Eigen::Matrix3d matrix_of(const cv::Matx33d& matrix) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.val);
}

}  // namespace

StereoOptics::StereoOptics(const StereoRig& rig, const CameraConfig& config,
                           const std::optional<StereoCalibration>& raw)
    : rig_(rig),
      vertical_misalignment_px_(config.vertical_misalignment_px),
      view_focal_px_(rig.focal_px),
      view_size_(rig.width_px, rig.height_px) {
  T_believed_true_right_.translation() = config.flex_position_m;
  if (const double angle_rad = config.flex_rotation_rad.norm(); angle_rad > 0)
    T_believed_true_right_.linear() =
        Eigen::AngleAxisd(angle_rad, config.flex_rotation_rad / angle_rad).toRotationMatrix();
  if (!raw) return;
  CameraCalibration right = raw->right;
  right.camera_matrix(1, 2) += vertical_misalignment_px_;  // the sensor sits higher, the picture lower
  const auto camera = [&](const CameraCalibration& calibration) {
    return RawCamera{matrix_of(calibration.rectification),
                     rays_of(calibration, {raw->width_px, raw->height_px})};
  };
  raw_.emplace(std::array<RawCamera, 2>{camera(raw->left), camera(right)});
  view_focal_px_ = oversampling * std::max(raw->left.camera_matrix(0, 0), raw->right.camera_matrix(0, 0));
  make_views();
}

/// Both views get the same focal length and size, because they are rendered side by side.
void StereoOptics::make_views() {
  view_size_ = {};
  constexpr int margin_px = 2;  // for the bilinear step
  for (RawCamera& camera : *raw_) {
    Eigen::AlignedBox2d extent;
    std::for_each(camera.rays.begin<cv::Vec2d>(), camera.rays.end<cv::Vec2d>(), [&](const cv::Vec2d& ray) {
      if (!std::isnan(ray[0])) extent.extend(Eigen::Vector2d(ray[0], ray[1]));
    });
    if (extent.isEmpty()) throw std::runtime_error("the distortion of these raw cameras cannot be undone");
    camera.center_x_px = margin_px - view_focal_px_ * extent.min().x();
    camera.center_y_px = margin_px - view_focal_px_ * extent.min().y();
    const Eigen::Vector2d size_px = view_focal_px_ * extent.sizes();
    view_size_.width = std::max(view_size_.width, static_cast<int>(std::ceil(size_px.x())) + 2 * margin_px);
    view_size_.height = std::max(view_size_.height, static_cast<int>(std::ceil(size_px.y())) + 2 * margin_px);
    cv::Mat map(camera.rays.size(), CV_32FC2);
    for (int row = 0; row < map.rows; ++row)
      for (int column = 0; column < map.cols; ++column) {
        const cv::Vec2d& ray = camera.rays.at<cv::Vec2d>(row, column);
        map.at<cv::Vec2f>(row, column) =
            std::isnan(ray[0]) ? cv::Vec2f(-9, -9)
                               : cv::Vec2f(static_cast<float>(view_focal_px_ * ray[0] + camera.center_x_px),
                                           static_cast<float>(view_focal_px_ * ray[1] + camera.center_y_px));
      }
    cv::convertMaps(map, cv::noArray(), camera.places, camera.fractions, CV_16SC2);
  }
}

std::array<Eye, 2> StereoOptics::eyes(const Eigen::Isometry3d& T_world_body_left,
                                      const Eigen::Isometry3d& T_world_body_right) const {
  std::array<Eye, 2> eyes{eyes_of(rig_, T_world_body_left)[0], eyes_of(rig_, T_world_body_right)[1]};
  eyes[1].T_world_camera = eyes[1].T_world_camera * T_believed_true_right_;
  if (!raw_) {
    eyes[1].center_y_px += vertical_misalignment_px_;
    return eyes;
  }
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    const RawCamera& camera = (*raw_)[i];
    eyes[i].T_world_camera.linear() = eyes[i].T_world_camera.linear() * camera.R_rectified_raw;
    eyes[i].focal_px = view_focal_px_;
    eyes[i].center_x_px = camera.center_x_px;
    eyes[i].center_y_px = camera.center_y_px;
    eyes[i].width_px = view_size_.width;
    eyes[i].height_px = view_size_.height;
  }
  return eyes;
}

cv::Mat StereoOptics::image(int eye, const cv::Mat& view) const {
  if (!raw_) return view;
  const RawCamera& camera = (*raw_)[static_cast<std::size_t>(eye)];
  cv::Mat image;
  cv::remap(view, image, camera.places, camera.fractions, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return image;
}

cv::Mat StereoOptics::falloff(int eye, double power) const {
  cv::Mat falloff(rig_.height_px, rig_.width_px, CV_32FC1);
  const std::array<double, 2> center_x_px{rig_.center_left_x_px, rig_.center_right_x_px};
  for (int row = 0; row < falloff.rows; ++row)
    for (int column = 0; column < falloff.cols; ++column) {
      double x = (column - center_x_px[static_cast<std::size_t>(eye)]) / rig_.focal_px;
      double y = (row - rig_.center_y_px) / rig_.focal_px;
      if (raw_) {
        const cv::Vec2d& ray = (*raw_)[static_cast<std::size_t>(eye)].rays.at<cv::Vec2d>(row, column);
        x = ray[0], y = ray[1];
      }
      const double fall = std::pow(1 + x * x + y * y, -0.5 * power);
      falloff.at<float>(row, column) = std::isnan(fall) ? 0.0f : static_cast<float>(fall);
    }
  return falloff;
}

}  // namespace understory
