#include "perception/io/calibration/write_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/core/persistence.hpp>
#include <utility>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

bool is_equidistant(const StereoCalibration& cameras) { return cameras.left.lens == LensModel::equidistant; }

/// A point x in raw left coordinates is R x + t in raw right ones: through the rectified pair, which is
/// turned alike.
std::pair<cv::Matx33d, cv::Vec3d> right_of_left(const StereoCalibration& cameras) {
  const cv::Matx33d R_raw_rectified = cameras.right.rectification.t();
  const double baseline_m = -cameras.right.projection(0, 3) / cameras.right.projection(0, 0);
  return {R_raw_rectified * cameras.left.rectification, R_raw_rectified * cv::Vec3d(-baseline_m, 0, 0)};
}

/// Pitch down, yaw to the left, roll to the right of read_rig, in degrees.
Eigen::Vector3d mounting_deg(const Eigen::Matrix3d& R_body_camera) {
  const Eigen::Matrix3d turned =
      R_body_camera * T_body_camera_of(Eigen::Vector3d::Zero(), 0).linear().transpose();
  const double yaw = std::atan2(turned(1, 0), turned(0, 0));
  const double pitch = std::atan2(-turned(2, 0), std::hypot(turned(0, 0), turned(1, 0)));
  // Of a camera that looks straight up or down yaw is arbitrary. What is left over it and pitch is roll.
  const Eigen::Matrix3d R_looking =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))
          .toRotationMatrix();
  const Eigen::Matrix3d rolled = R_looking.transpose() * turned;
  return Eigen::Vector3d(pitch, yaw, std::atan2(rolled(2, 1), rolled(1, 1))) * 180 / std::numbers::pi;
}

std::string quoted(const std::string& word) {
  std::string text = "\"";
  for (const char c : word) {
    if (c == '"' || c == '\\') text += '\\';
    text += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return text + "\"";
}

std::string rig_text(const StereoRig& rig) {
  const Eigen::Vector3d mounting = mounting_deg(rig.T_body_camera.linear());
  std::string text = fmt::format(
      "name: {}\nwidth_px: {}\nheight_px: {}\nfocal_px: {}\nbaseline_m: {}\ncenter_left_x_px: {}\n"
      "center_right_x_px: {}\ncenter_y_px: {}\ndetection_depth_m: {}\n"
      "# Of the left camera in the body (x forward, y left, z up of the centre of mass).\n"
      "left_camera_body_m: [{}]\npitch_down_deg: {}\n",
      quoted(rig.name), rig.width_px, rig.height_px, rig.focal_px, rig.baseline_m, rig.center_left_x_px,
      rig.center_right_x_px, rig.center_y_px, rig.detection_depth_m,
      list_text({rig.T_body_camera.translation().data(), 3}), mounting[0]);
  if (mounting[1] != 0 || mounting[2] != 0)
    text += fmt::format("yaw_left_deg: {}\nroll_right_deg: {}\n", mounting[1], mounting[2]);
  return text;
}

/// `extension`: .xml, .yaml, .yml or .json.
std::string opencv_text(const StereoCalibration& cameras, const std::string& extension) {
  cv::FileStorage storage("calibration" + extension, cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  const auto write = [&](const char* key, const auto& matrix) { storage << key << cv::Mat(matrix); };
  const auto [R_right_left, t_right_m] = right_of_left(cameras);
  const CameraCalibration &left = cameras.left, &right = cameras.right;
  storage << "image_width" << cameras.width_px << "image_height" << cameras.height_px;
  if (is_equidistant(cameras)) storage << "fisheye_model" << 1;
  write("M1", left.camera_matrix);
  write("D1", cv::Mat(left.distortion).reshape(1, 1));
  write("M2", right.camera_matrix);
  write("D2", cv::Mat(right.distortion).reshape(1, 1));
  write("R", R_right_left);
  write("T", t_right_m);
  write("R1", left.rectification);
  write("R2", right.rectification);
  write("P1", left.projection);
  write("P2", right.projection);
  return storage.releaseAndGetString();
}

/// The first `count` coefficients. Throws InputError where one that is left out is not 0.
std::vector<double> coefficients(const CameraCalibration& camera, std::size_t count, const fs::path& out) {
  std::vector<double> all = camera.distortion;
  if (std::any_of(all.begin() + static_cast<std::ptrdiff_t>(std::min(count, all.size())), all.end(),
                  [](double one) { return one != 0; }))
    refuse_input(out.string(), "distortion_coeffs",
                 fmt::format("this lens has {} coefficients, and Kalibr's has {}: OpenCV's and ROS's forms "
                             "have all of them",
                             all.size(), count));
  all.resize(count);
  return all;
}

std::string kalibr_camera_text(const char* name, const CameraCalibration& camera,
                               const StereoCalibration& cameras, const std::string& pose,
                               const fs::path& out) {
  const cv::Matx33d& K = camera.camera_matrix;
  return fmt::format(
      "{}:\n{}  camera_model: pinhole\n  distortion_coeffs: [{}]\n  distortion_model: {}\n"
      "  intrinsics: [{}, {}, {}, {}]\n  resolution: [{}, {}]\n  rostopic: /{}/image_raw\n",
      name, pose, list_text(coefficients(camera, 4, out)), is_equidistant(cameras) ? "equidistant" : "radtan",
      K(0, 0), K(1, 1), K(0, 2), K(1, 2), cameras.width_px, cameras.height_px, name);
}

std::string kalibr_text(const StereoCalibration& cameras, const fs::path& out) {
  const auto [R, t] = right_of_left(cameras);
  std::string pose = "  T_cn_cnm1:\n";
  for (int row = 0; row < 3; ++row)
    pose += fmt::format("  - [{}, {}, {}, {}]\n", R(row, 0), R(row, 1), R(row, 2), t[row]);
  pose += "  - [0.0, 0.0, 0.0, 1.0]\n";
  return kalibr_camera_text("cam0", cameras.left, cameras, "", out) +
         kalibr_camera_text("cam1", cameras.right, cameras, pose, out);
}

std::string ros_text(const char* name, const CameraCalibration& camera, const StereoCalibration& cameras) {
  const auto matrix = [](const char* key, int rows, int cols, std::span<const double> values) {
    return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", key, rows, cols, list_text(values));
  };
  const bool has_eight = camera.distortion.size() > 5;
  std::vector<double> numbers = camera.distortion;
  numbers.resize(is_equidistant(cameras) ? 4 : has_eight ? 8 : 5);
  const char* model = is_equidistant(cameras) ? "equidistant"
                      : has_eight             ? "rational_polynomial"
                                              : "plumb_bob";
  return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", cameras.width_px,
                     cameras.height_px, name) +
         matrix("camera_matrix", 3, 3, camera.camera_matrix.val) +
         fmt::format("distortion_model: {}\n", model) +
         matrix("distortion_coefficients", 1, static_cast<int>(numbers.size()), numbers) +
         matrix("rectification_matrix", 3, 3, camera.rectification.val) +
         matrix("projection_matrix", 3, 4, camera.projection.val);
}

void require_extension(const fs::path& out, std::span<const std::string_view> extensions) {
  if (std::ranges::find(extensions, out.extension().string()) == extensions.end())
    refuse_input(out.string(), "", fmt::format("the name must end in {}", fmt::join(extensions, ", ")));
}

}  // namespace

StereoCalibration cameras_of(const CalibratedRig& calibrated) {
  if (calibrated.calibration) return *calibrated.calibration;
  const StereoRig& rig = calibrated.rig;
  return {rig.name,
          rig.width_px,
          rig.height_px,
          rectified_camera(rig, rig.center_left_x_px, 0),
          rectified_camera(rig, rig.center_right_x_px, rig.baseline_m),
          rig.T_body_camera};
}

std::string list_text(std::span<const double> values) {
  std::string text;  // with fmt::join every file would compile fmt's writing of numbers anew
  for (const double value : values) text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
  return text;
}

std::vector<CalibrationText> calibration_texts(const CalibratedRig& calibrated, CalibrationForm form,
                                               const fs::path& out) {
  constexpr std::array<std::string_view, 1> yaml{".yaml"};
  constexpr std::array<std::string_view, 4> of_opencv{".xml", ".yaml", ".yml", ".json"};
  const StereoCalibration cameras = cameras_of(calibrated);
  if (form == CalibrationForm::opencv) {
    require_extension(out, of_opencv);
    return {{out, opencv_text(cameras, out.extension().string())}};
  }
  if (form == CalibrationForm::ros) {
    if (out.has_extension())
      refuse_input(out.string(), "", "must be a folder: ROS has a file for each camera");
    return {{out / "left.yaml", ros_text("left", cameras.left, cameras)},
            {out / "right.yaml", ros_text("right", cameras.right, cameras)}};
  }
  require_extension(out, yaml);
  if (form == CalibrationForm::kalibr) return {{out, kalibr_text(cameras, out)}};
  std::vector<CalibrationText> texts{{out, rig_text(calibrated.rig)}};
  if (calibrated.calibration)
    texts.push_back({raw_file_of(out), opencv_text(cameras, raw_file_of(out).extension().string())});
  return texts;
}

}  // namespace understory
