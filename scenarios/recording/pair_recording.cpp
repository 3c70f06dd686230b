#include "scenarios/recording/pair_recording.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "perception/io/calibration/write_calibration.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/report/pictures.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// Whether the right camera sees the same place: it lies in its image, and nothing nearer stands before it
/// there, or at the next pixel to either side.
bool is_shared(const TrueView& view, int row, int column, float disparity_px) {
  const float depth_m = view.depth_m.at<float>(row, column);
  const auto there = static_cast<int>(std::lround(static_cast<float>(column) - disparity_px));
  if (there < 0 || there >= view.right_depth_m.cols) return false;
  for (int beside = std::max(0, there - 1); beside <= std::min(there + 1, view.right_depth_m.cols - 1);
       ++beside)
    if (std::abs(view.right_depth_m.at<float>(row, beside) - depth_m) < 0.02F * depth_m) return true;
  return false;
}

/// 0 where it is not known, or does not fit.
cv::Mat in_256ths(const cv::Mat& disparity_px) {
  cv::Mat numbers, known = disparity_px.clone();
  known.setTo(0, disparity_px > 255.99);
  known.convertTo(numbers, CV_16U, 256);
  return numbers;
}

/// One channel, rows from the bottom up, little endian.
std::string pfm_bytes(const cv::Mat& values) {
  std::string bytes = fmt::format("Pf\n{} {}\n-1.0\n", values.cols, values.rows);
  for (int row = values.rows - 1; row >= 0; --row)
    bytes.append(reinterpret_cast<const char*>(values.ptr<float>(row)),
                 static_cast<std::size_t>(values.cols) * sizeof(float));
  return bytes;
}

/// P0 and P1, rows of 3x4; of gray cameras.
std::string kitti_calibration_text(const StereoRig& rig) {
  const StereoCalibration cameras = cameras_of({rig, std::nullopt});
  std::string text = "P0:";
  for (const double value : cameras.left.projection.val) text += fmt::format(" {:.12e}", value);
  text += "\nP1:";
  for (const double value : cameras.right.projection.val) text += fmt::format(" {:.12e}", value);
  return text + "\n";
}

std::string middlebury_calibration_text(const StereoRig& rig) {
  const auto camera = [&](double center_x_px) {
    return fmt::format("[{0} 0 {1}; 0 {0} {2}; 0 0 1]", rig.focal_px, center_x_px, rig.center_y_px);
  };
  return fmt::format("cam0={}\ncam1={}\ndoffs={}\nbaseline={}\nwidth={}\nheight={}\nndisp={}\n",
                     camera(rig.center_left_x_px), camera(rig.center_right_x_px),
                     rig.center_right_x_px - rig.center_left_x_px, 1000 * rig.baseline_m, rig.width_px,
                     rig.height_px, rig.width_px);
}

}  // namespace

PairRecording::PairRecording(const fs::path& folder, const CalibratedRig& rig, const RecordingChoice& choice)
    : Recording(choice.every), folder_(folder), rig_(rig.rig), form_(*choice.form) {
  if (rig.calibration)
    throw ScenarioError(
        "cameras.raw: KITTI's and Middlebury's forms hold rectified pairs; --format euroc holds raw ones");
  const bool is_kitti = form_ == RecordingForm::kitti;
  if (is_kitti && rig_.infinity_disparity_px() < 0)
    throw ScenarioError(fmt::format(
        "rig {}: its disparities can be negative (infinity lies at {:.1f} px), which KITTI's form cannot "
        "say; --format middlebury can",
        rig_.name, rig_.infinity_disparity_px()));
  if (!is_kitti) return;
  for (const char* part : {"image_0", "image_1", "disp_occ", "disp_noc", "calib"})
    prepare_output_folder(folder_ / "training" / part);
}

void PairRecording::add_frame(const StereoFrame& frame, const Truth& truth, const TrueView& view) {
  // Infinite where nothing is, as in the sky.
  cv::Mat disparity_px = rig_.focal_px * rig_.baseline_m / view.depth_m + rig_.infinity_disparity_px();
  disparity_px.setTo(std::numeric_limits<float>::infinity(), view.objects == 0);
  cv::Mat shared(disparity_px.size(), CV_8UC1);  // as Middlebury's mask: 255 both see it, 128 one, 0 unknown
  for (int row = 0; row < shared.rows; ++row)
    for (int column = 0; column < shared.cols; ++column) {
      const float value = disparity_px.at<float>(row, column);
      shared.at<std::uint8_t>(row, column) = !std::isfinite(value)                 ? 0
                                             : is_shared(view, row, column, value) ? 255
                                                                                   : 128;
    }
  if (form_ == RecordingForm::kitti) {
    const fs::path to = folder_ / "training";
    const std::string number = fmt::format("{:06}", frames()), name = number + "_10.png";
    cv::Mat not_hidden = disparity_px.clone();
    not_hidden.setTo(std::numeric_limits<float>::infinity(), shared != 255);
    write_picture(to / "image_0" / name, frame.left);
    write_picture(to / "image_1" / name, frame.right);
    write_picture(to / "disp_occ" / name, in_256ths(disparity_px));
    write_picture(to / "disp_noc" / name, in_256ths(not_hidden));
    write_whole_file(to / "calib" / (number + ".txt"), kitti_calibration_text(rig_));
  } else {
    const fs::path to = folder_ / "pairs" / fmt::format("{:06}", frames());
    prepare_output_folder(to);
    write_picture(to / "im0.png", frame.left);
    write_picture(to / "im1.png", frame.right);
    write_whole_file(to / "disp0.pfm", pfm_bytes(disparity_px));
    write_picture(to / "mask0nocc.png", shared);
    write_whole_file(to / "calib.txt", middlebury_calibration_text(rig_));
  }
  const Eigen::Isometry3d T_world_camera = truth.T_world_body * rig_.T_body_camera;
  if (!T_first_world_) T_first_world_ = T_world_camera.inverse();
  const Eigen::Matrix<double, 3, 4> pose = (*T_first_world_ * T_world_camera).matrix().topRows<3>();
  for (int i = 0; i < 12; ++i) poses_ += fmt::format("{:.9e}{}", pose(i / 4, i % 4), i == 11 ? "\n" : " ");
  times_ += fmt::format("{:.9e}\n", 1e-9 * static_cast<double>(frame.t_ns));
}

void PairRecording::finish() {
  require_frames(folder_);
  const fs::path to = folder_ / (form_ == RecordingForm::kitti ? "training" : "pairs");
  write_whole_file(to / "poses.txt", poses_);
  write_whole_file(to / "times.txt", times_);
}

}  // namespace understory
