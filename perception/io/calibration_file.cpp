#include "perception/io/calibration_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>

#include "perception/io/calibration_formats.hpp"
#include "perception/io/field_reader.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using namespace rig_limits;

/// The file's or folder's own name; a EuRoC folder goes by the name above its mav0.
std::string name_of(const fs::path& path) {
  fs::path named = fs::absolute(path).lexically_normal();
  if (!named.has_filename()) named = named.parent_path();
  if (named.filename() == "mav0") named = named.parent_path();
  std::error_code ignored;
  return fs::is_directory(path, ignored) ? named.filename().string() : named.stem().string();
}

void look_at(StereoRig& rig, double detection_depth_m, const fs::path& path) {
  rig.detection_depth_m = detection_depth_m;
  if (!(detection_depth_m >= minimum_depth_m && detection_depth_m <= maximum_depth_m))
    refuse_input(
        path.string(), "detection depth",
        fmt::format("must be from {} to {} m, is {}", minimum_depth_m, maximum_depth_m, detection_depth_m));
  if (!rig.can_look_at(std::round(rig.disparity_px(detection_depth_m))))
    refuse_input(
        path.string(), "detection depth",
        fmt::format("must be a depth more than a pixel of disparity nearer than infinity and inside "
                    "the image, {:.4g} m lies at {:.1f} px with infinity at {:.1f} px",
                    detection_depth_m, rig.disparity_px(detection_depth_m), rig.infinity_disparity_px()));
}

/// What read_rig asks of a rig file's keys, asked of a rig computed from matrices.
void require_in_range(const StereoRig& rig, const fs::path& path) {
  const auto require = [&](const std::string& key, double value, double minimum, double maximum,
                           const std::string& hint) {
    if (!(value >= minimum && value <= maximum))
      refuse_input(path.string(), key,
                   fmt::format("must be from {} to {}, is {:.6g}{}", minimum, maximum, value, hint));
  };
  require("focal length in px", rig.focal_px, minimum_focal_px, maximum_focal_px, "");
  require("baseline in m", rig.baseline_m, minimum_baseline_m, maximum_baseline_m,
          "; are the translations in another unit (--unit)?");
  for (const double center_px : {rig.center_left_x_px, rig.center_right_x_px, rig.center_y_px})
    require("principal point in px", center_px, minimum_center_px, maximum_center_px, "");
}

/// Whether rectifying would leave this camera's images as they are.
bool is_rectified(const CameraCalibration& camera) {
  const bool is_bent = std::any_of(camera.distortion.begin(), camera.distortion.end(),
                                   [](double coefficient) { return coefficient != 0; });
  return !is_bent && camera.rectification == cv::Matx33d::eye() &&
         camera.projection.get_minor<3, 3>(0, 0) == camera.camera_matrix;
}

/// A rig file as it stands.
struct RigText {
  StereoRig rig;
  Eigen::Vector3d left_camera_body_m = Eigen::Vector3d::Zero();
  double pitch_down_deg = 0;
};

void visit_fields(FieldVisitor& visit, RigText& text) {
  visit("name", text.rig.name);
  visit("width_px", text.rig.width_px, minimum_size_px, maximum_size_px);
  visit("height_px", text.rig.height_px, minimum_size_px, maximum_size_px);
  visit("focal_px", text.rig.focal_px, minimum_focal_px, maximum_focal_px);
  visit("baseline_m", text.rig.baseline_m, minimum_baseline_m, maximum_baseline_m);
  visit("center_left_x_px", text.rig.center_left_x_px, minimum_center_px, maximum_center_px);
  visit("center_right_x_px", text.rig.center_right_x_px, minimum_center_px, maximum_center_px);
  visit("center_y_px", text.rig.center_y_px, minimum_center_px, maximum_center_px);
  visit("detection_depth_m", text.rig.detection_depth_m, minimum_depth_m, maximum_depth_m);
  visit("left_camera_body_m", text.left_camera_body_m, -maximum_offset_m, maximum_offset_m);
  visit("pitch_down_deg", text.pitch_down_deg, -90, 90);
}

CalibratedRig from_rig_file(const fs::path& path, const CalibrationOptions& options) {
  if (options.meters_per_unit != 1)
    refuse_input(path.string(), "unit", "a rig file is in metres: --unit is for OpenCV's files");
  CalibratedRig read{read_rig(path), std::nullopt};
  agreed_image_size(path.string(), ImageSize{read.rig.width_px, read.rig.height_px}, options);
  look_at(read.rig, options.detection_depth_m.value_or(read.rig.detection_depth_m), path);
  return read;
}

CalibratedRig from_cameras(StereoCalibration calibration, const fs::path& path,
                           const CalibrationOptions& options,
                           std::optional<double> depth_said_m = std::nullopt) {
  const double default_depth_m = depth_said_m.value_or(10);
  calibration.name = path.string();  // rectified_rig begins its complaints with it
  CalibratedRig read;
  read.rig = rectified_rig(calibration, default_depth_m);
  read.rig.name = calibration.name = name_of(path);
  require_in_range(read.rig, path);
  look_at(read.rig, options.detection_depth_m.value_or(default_depth_m), path);
  read.calibration = std::move(calibration);
  return read;
}

/// Says which form a calibration has that people have and that is not read: a file, or one in the folder.
void refuse_other_forms(const fs::path& path) {
  using Marks = std::vector<const char*>;
  const std::vector<std::pair<const char*, Marks>> forms{
      {"OpenCV's JSON", {"{", "\"opencv-matrix\"", "\"rows\":"}},
      {"OpenCV's base64 (WRITE_BASE64)", {"opencv-matrix", "!!binary"}},
      {"OpenCV's base64 (WRITE_BASE64)", {"opencv-matrix", "\"binary\""}},
      {"Kalibr's camchain", {"camera_model:", "distortion_coeffs:"}},
      {"ROS's camera_info", {"camera_matrix:", "projection_matrix:"}},
      {"KITTI's", {"P0:", "P1:"}},
      {"KITTI's", {"P_rect_00:", "P_rect_01:"}},
      {"Middlebury's", {"cam0=[", "cam1=["}},
      {"one camera's sensor.yaml of a EuRoC folder", {"T_BS:", "distortion_coefficients:"}}};
  std::error_code ignored;
  std::vector<fs::path> files{path};
  for (const auto& entry : fs::directory_iterator(path, ignored)) files.push_back(entry.path());
  for (const fs::path& file : files) {
    if (!fs::is_regular_file(file, ignored) || fs::file_size(file, ignored) > maximum_keyed_bytes) continue;
    const std::string text = read_file(file);
    for (const auto& [form, marks] : forms)
      if (std::ranges::all_of(marks, [&](const char* mark) { return text.find(mark) != std::string::npos; }))
        refuse_input(
            file.string(), "",
            fmt::format(
                "this calibration is {}, which is not read; read are a rig file, OpenCV's XML or YAML with "
                "M1 D1 M2 D2 and R T or R1 R2 P1 P2, and a EuRoC folder (docs/detect.md)",
                form));
  }
}

CalibratedRig read_any_form(const fs::path& path, const CalibrationOptions& options) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    if (const auto folder = euroc_folder(path)) {
      const EurocCalibration euroc = read_euroc_calibration(*folder, options);
      CalibratedRig read = from_cameras(euroc.calibration, path, options, euroc.detection_depth_m);
      if (is_rectified(read.calibration->left) && is_rectified(read.calibration->right))
        read.calibration.reset();
      return read;
    }
    return from_cameras(read_opencv_calibration(path, options), path, options);
  }
  if (looks_like_opencv(read_file(path)))
    return from_cameras(read_opencv_calibration(path, options), path, options);
  return from_rig_file(path, options);
}

}  // namespace

ImageSize agreed_image_size(const std::string& file, std::optional<ImageSize> of_file,
                            const CalibrationOptions& options) {
  const auto fail = [&](const std::string& expected) { refuse_input(file, "image size", expected); };
  const auto in_range = [](int size_px) { return size_px >= minimum_size_px && size_px <= maximum_size_px; };
  if (options.width_px.has_value() != options.height_px.has_value())
    fail("image_width and image_height belong together, one is missing");
  if (!options.width_px) {
    if (of_file) return *of_file;
    if (options.images_at_hand) return {options.images_at_hand->width, options.images_at_hand->height};
    fail("not in the file (image_width, image_height): name it with --size WxH");
  }
  const ImageSize given{*options.width_px, *options.height_px};
  if (!in_range(given.width_px) || !in_range(given.height_px))
    fail(fmt::format("must be from {} to {} px, is {}x{}", minimum_size_px, maximum_size_px, given.width_px,
                     given.height_px));
  if (of_file && *of_file != given)
    fail(fmt::format("the file says {}x{}, --size says {}x{}", of_file->width_px, of_file->height_px,
                     given.width_px, given.height_px));
  return given;
}

bool is_rotation(const cv::Matx33d& matrix) {
  constexpr double tolerance = 1e-3;
  return cv::norm(matrix * matrix.t() - cv::Matx33d::eye(), cv::NORM_INF) < tolerance &&
         cv::determinant(matrix) > 0;
}

bool rectify_pair(StereoCalibration& calibration, const cv::Matx33d& R_right_left,
                  const cv::Vec3d& t_right_m) {
  CameraCalibration& left = calibration.left;
  CameraCalibration& right = calibration.right;
  const cv::Size size(calibration.width_px, calibration.height_px);
  cv::Mat disparity_to_depth;
  try {
    cv::stereoRectify(left.camera_matrix, left.distortion, right.camera_matrix, right.distortion, size,
                      R_right_left, t_right_m, left.rectification, right.rectification, left.projection,
                      right.projection, disparity_to_depth, cv::CALIB_ZERO_DISPARITY, 0, size);
  } catch (const cv::Exception&) {
    return false;  // the caller knows the file's name
  }
  double sum = 0;  // finite only if every term is
  for (const CameraCalibration* camera : {&left, &right}) {
    for (const double value : camera->rectification.val) sum += value;
    for (const double value : camera->projection.val) sum += value;
  }
  return std::isfinite(sum);
}

Eigen::Isometry3d T_body_camera_of(const Eigen::Vector3d& left_camera_body_m, double pitch_down_rad) {
  const double c = std::cos(pitch_down_rad), s = std::sin(pitch_down_rad);
  Eigen::Isometry3d T_body_camera = Eigen::Isometry3d::Identity();
  T_body_camera.linear().col(0) = Eigen::Vector3d(0, -1, 0);   // camera x: to the right
  T_body_camera.linear().col(1) = Eigen::Vector3d(-s, 0, -c);  // camera y: down
  T_body_camera.linear().col(2) = Eigen::Vector3d(c, 0, -s);   // camera z: ahead
  T_body_camera.translation() = left_camera_body_m;
  return T_body_camera;
}

StereoRig read_rig(const std::filesystem::path& file) {
  const TextNode map = parse_yaml(read_file(file), file.string());
  RigText text;
  read_fields(map, fields_of(text), "", Keys::all_required);
  StereoRig& rig = text.rig;
  if (rig.name.empty()) refuse_input(map.origin, "name", "expected a word");
  rig.T_body_camera = T_body_camera_of(text.left_camera_body_m, text.pitch_down_deg * std::numbers::pi / 180);
  if (!rig.can_look_at(std::round(rig.disparity_px(rig.detection_depth_m))))
    refuse_input(find_child(map, "detection_depth_m")->origin, "detection_depth_m",
                 "must be a depth more than a pixel of disparity nearer than infinity and inside the image");
  return rig;
}

CalibratedRig read_calibrated_rig(const fs::path& path, const CalibrationOptions& options) {
  if (!(options.meters_per_unit > 0 && options.meters_per_unit <= 1000))
    refuse_input(path.string(), "unit", "must be above 0 and at most 1000 m");
  try {
    return read_any_form(path, options);
  } catch (const InputError&) {
    refuse_other_forms(path);
    throw;
  }
}

}  // namespace understory
