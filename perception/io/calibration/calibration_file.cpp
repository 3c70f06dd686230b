#include "perception/io/calibration/calibration_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "perception/io/calibration/calibration_forms.hpp"
#include "perception/io/field_reader.hpp"
#include "perception/io/image_file.hpp"
#include "perception/io/image_sequence.hpp"
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
  return !camera.bends() && camera.rectification == cv::Matx33d::eye() &&
         camera.projection.get_minor<3, 3>(0, 0) == camera.camera_matrix;
}

/// A rig file as it stands.
struct RigText {
  StereoRig rig;
  Eigen::Vector3d left_camera_body_m = Eigen::Vector3d::Zero();
  double pitch_down_deg = 0;
  std::optional<double> yaw_left_deg = {}, roll_right_deg = {};
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
  visit("yaw_left_deg", text.yaw_left_deg, -180, 180);
  visit("roll_right_deg", text.roll_right_deg, -180, 180);
}

CalibratedRig from_rig_file(const fs::path& path, const CalibrationOptions& options) {
  require_metres(path.string(), "a rig file", options);
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
  for (const CameraCalibration* camera : {&calibration.left, &calibration.right}) {
    const cv::Matx33d& K = camera->camera_matrix;
    if (std::abs(K(0, 2) / calibration.width_px - 0.5) > 1 ||
        std::abs(K(1, 2) / calibration.height_px - 0.5) > 1)
      refuse_input(path.string(), "principal point",
                   fmt::format("of the raw image must be in or near it, is ({:.6g}, {:.6g}) of {}x{} px",
                               K(0, 2), K(1, 2), calibration.width_px, calibration.height_px));
  }
  CalibratedRig read;
  read.rig = rectified_rig(calibration, default_depth_m);
  read.rig.name = calibration.name = name_of(path);
  require_in_range(read.rig, path);
  look_at(read.rig, options.detection_depth_m.value_or(default_depth_m), path);
  if (!is_rectified(calibration.left) || !is_rectified(calibration.right))
    read.calibration = std::move(calibration);
  return read;
}

/// Of a form that states no unit: a baseline that is hardly one in metres was written in another.
CalibratedRig from_unstated_unit(StereoCalibration calibration, const fs::path& path,
                                 const CalibrationOptions& options) {
  constexpr double nearest_m = 0.01, widest_m = 1;
  CalibratedRig read = from_cameras(std::move(calibration), path, options);
  const double baseline_m = read.rig.baseline_m;
  if (!options.meters_per_unit && !(baseline_m >= nearest_m && baseline_m <= widest_m))
    refuse_input(
        path.string(), "baseline",
        fmt::format("is {:.6g} in a unit that the file does not state: say it with --unit m, cm, mm, "
                    "or the metres of a chessboard's square, as --unit 0.025",
                    baseline_m));
  return read;
}

enum class Form { rig_file, opencv, kalibr, ros, kitti, middlebury, euroc_camera };

/// What a calibration's text gives away.
Form form_of(const std::string& text) {
  const auto has = [&](std::string_view mark) { return text.find(mark) != std::string::npos; };
  const auto begins_line = [&](const std::string& mark) {
    return text.starts_with(mark) || has("\n" + mark);
  };
  if (looks_like_opencv(text)) return Form::opencv;
  if (has("T_BS:")) return Form::euroc_camera;
  if (has("camera_model:") && has("distortion_coeffs:")) return Form::kalibr;
  if (has("camera_matrix:") && has("projection_matrix:")) return Form::ros;
  if (begins_line("cam0=")) return Form::middlebury;
  for (const char* key : {"P0:", "P2:", "P_rect_00:", "P_rect_02:"})
    if (begins_line(key)) return Form::kitti;
  return Form::rig_file;
}

/// The other camera's file beside this one: left.yaml and right.yaml.
fs::path partner_of(const fs::path& file) {
  const std::string name = file.filename().string();
  for (const auto& [mine, other] : {std::pair<std::string, std::string>("left", "right"),
                                    {"right", "left"},
                                    {"cam0", "cam1"},
                                    {"cam1", "cam0"}})
    if (const std::size_t at = name.find(mine); at != std::string::npos) {
      std::string partner = name;
      const fs::path beside = file.parent_path() / partner.replace(at, mine.size(), other);
      std::error_code ignored;
      if (fs::is_regular_file(beside, ignored)) return beside;
    }
  refuse_input(
      file.string(), "",
      "this is one camera of ROS's camera_info: name the folder that holds the files of both, or call "
      "them left.yaml and right.yaml");
}

CalibratedRig read_form(Form form, const fs::path& file, const fs::path& path,
                        const CalibrationOptions& options) {
  switch (form) {
    case Form::opencv:
      return from_unstated_unit(read_opencv_calibration(file, options), path, options);
    case Form::kalibr:
      return from_cameras(read_kalibr_calibration(file, options), path, options);
    case Form::ros:
      return from_unstated_unit(read_ros_calibration({file, partner_of(file)}, options), path, options);
    case Form::kitti:
      return from_cameras(read_kitti_calibration(file, options), path, options);
    case Form::middlebury:
      return from_cameras(read_middlebury_calibration(file, options), path, options);
    case Form::euroc_camera:
      refuse_input(file.string(), "",
                   "this is one camera of a EuRoC folder: name the folder that holds cam0 and cam1");
    case Form::rig_file:
      break;
  }
  return from_rig_file(file, options);
}

/// A folder that is not EuRoC's: OpenCV's matrices, two files of ROS, or one file of another form.
CalibratedRig read_folder(const fs::path& path, const CalibrationOptions& options) {
  std::error_code ignored;
  std::vector<fs::path> files;  // pictures lie beside a data set's calibration: they are not opened
  for (const auto& entry : fs::directory_iterator(path, ignored))
    if (entry.is_regular_file(ignored) && entry.file_size(ignored) <= maximum_keyed_bytes &&
        !is_image_name(entry.path()))
      files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<std::pair<Form, fs::path>> told;
  for (const fs::path& file : files)
    if (const Form form = form_of(calibration_text(file)); form != Form::rig_file)
      told.emplace_back(form, file);
  const auto is_of_ros = [](const auto& one) { return one.first == Form::ros; };
  if (told.size() == 2 && std::ranges::all_of(told, is_of_ros))
    return from_unstated_unit(read_ros_calibration({told[0].second, told[1].second}, options), path, options);
  if (told.size() == 1 && told[0].first != Form::opencv)
    return read_form(told[0].first, told[0].second, path, options);
  return from_unstated_unit(read_opencv_calibration(path, options), path, options);
}

CalibratedRig read_any_form(const fs::path& path, const CalibrationOptions& options) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored))
    return read_form(form_of(calibration_text(path)), path, path, options);
  const auto folder = euroc_folder(path);
  if (!folder) return read_folder(path, options);
  const EurocCalibration euroc = read_euroc_calibration(*folder, options);
  return from_cameras(euroc.calibration, path, options, euroc.detection_depth_m);
}

}  // namespace

Eigen::Isometry3d T_body_camera_of(const Eigen::Vector3d& left_camera_body_m, double pitch_down_rad,
                                   double yaw_left_rad, double roll_right_rad) {
  const double c = std::cos(pitch_down_rad), s = std::sin(pitch_down_rad);
  Eigen::Isometry3d T_body_camera = Eigen::Isometry3d::Identity();
  T_body_camera.linear().col(0) = Eigen::Vector3d(0, -1, 0);   // camera x: to the right
  T_body_camera.linear().col(1) = Eigen::Vector3d(-s, 0, -c);  // camera y: down
  T_body_camera.linear().col(2) = Eigen::Vector3d(c, 0, -s);   // camera z: ahead
  if (yaw_left_rad != 0 || roll_right_rad != 0) {
    const Eigen::Matrix3d ahead_only = T_body_camera_of(Eigen::Vector3d::Zero(), 0).linear();
    T_body_camera.linear() = Eigen::AngleAxisd(yaw_left_rad, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(pitch_down_rad, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(roll_right_rad, Eigen::Vector3d::UnitX()) * ahead_only;
  }
  T_body_camera.translation() = left_camera_body_m;
  return T_body_camera;
}

fs::path raw_file_of(const fs::path& rig_file) {
  return rig_file.parent_path() / "raw" / (rig_file.stem().string() + ".xml");
}

StereoRig read_rig(const std::filesystem::path& file) {
  const std::string content = read_file(file);
  if (form_of(content) != Form::rig_file)
    refuse_input(
        file.string(), "",
        fmt::format("must be a rig file: understory rig {} --out rig.yaml makes one of this calibration",
                    file.string()));
  const TextNode map = parse_yaml(content, file.string());
  RigText text;
  read_fields(map, fields_of(text), "", Keys::all_required);
  StereoRig& rig = text.rig;
  if (rig.name.empty()) refuse_input(map.origin, "name", "expected a word");
  const auto radians = [](double angle_deg) { return angle_deg * std::numbers::pi / 180; };
  rig.T_body_camera =
      T_body_camera_of(text.left_camera_body_m, radians(text.pitch_down_deg),
                       radians(text.yaw_left_deg.value_or(0)), radians(text.roll_right_deg.value_or(0)));
  if (!rig.can_look_at(std::round(rig.disparity_px(rig.detection_depth_m))))
    refuse_input(find_child(map, "detection_depth_m")->origin, "detection_depth_m",
                 "must be a depth more than a pixel of disparity nearer than infinity and inside the image");
  return rig;
}

CalibratedRig read_calibrated_rig(const fs::path& path, const CalibrationOptions& options) {
  const double unit_m = options.meters_per_unit.value_or(1);
  if (!(unit_m > 0 && unit_m <= 1000))
    refuse_input(path.string(), "unit", "must be above 0 and at most 1000 m");
  return read_any_form(path, options);
}

}  // namespace understory
