#include "perception/io/opencv_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "perception/io/image_size.hpp"
#include "perception/io/opencv_matrix.hpp"
#include "perception/io/rig_file.hpp"
#include "perception/io/rig_limits.hpp"
#include "perception/io/stereo_rectification.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

bool is_xml(const std::string& text) {
  const std::size_t first = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  return first != std::string::npos && text[first] == '<';
}

StrictMap read_map(const fs::path& file) {
  const std::string text = read_text_file(file), name = file.string();
  return {name, is_xml(text) ? parse_opencv_xml(text, name) : parse_yaml(text, name)};
}

/// The file, or the folder's files, in which the matrices are looked up by name.
class Matrices {
 public:
  explicit Matrices(const fs::path& path) : path_(path) {
    std::error_code ignored;
    is_folder_ = fs::is_directory(path, ignored);
    if (!is_folder_) {
      maps_.push_back(read_map(path));
      return;
    }
    for (const char* name :
         {"intrinsics", "extrinsics", "M1", "D1", "R1", "P1", "M2", "D2", "R2", "P2", "R", "T"})
      for (const char* extension : {".xml", ".yml", ".yaml"})
        if (const fs::path file = path / (name + std::string(extension)); fs::exists(file, ignored))
          maps_.push_back(read_map(file));
  }

  bool has(const std::string& key) const {
    for (const StrictMap& map : maps_)
      if (map.has(key)) return true;
    return false;
  }

  /// The one map that holds `key`.
  StrictMap& with(const std::string& key) {
    StrictMap* holder = nullptr;
    for (StrictMap& map : maps_) {
      if (!map.has(key)) continue;
      if (holder != nullptr) map.fail(key, "expected once, found in " + holder->file() + " too");
      holder = &map;
    }
    if (holder == nullptr)
      throw_file_fault(path_.string(), 0, key,
                       is_folder_ ? fmt::format("expected this key in {0}.xml, {0}.yml or {0}.yaml", key)
                                  : "expected this key, found none");
    return *holder;
  }

 private:
  fs::path path_;
  bool is_folder_ = false;
  std::vector<StrictMap> maps_;
};

std::optional<ImageSize> size_in(Matrices& matrices) {
  using namespace rig_limits;
  if (!matrices.has("image_width") && !matrices.has("image_height")) return std::nullopt;
  return ImageSize{matrices.with("image_width").whole("image_width", minimum_size_px, maximum_size_px),
                   matrices.with("image_height").whole("image_height", minimum_size_px, maximum_size_px)};
}

void read_rectification(Matrices& matrices, StereoCalibration& calibration, double meters_per_unit) {
  calibration.left.rectification = opencv_rotation(matrices.with("R1"), "R1");
  calibration.right.rectification = opencv_rotation(matrices.with("R2"), "R2");
  calibration.left.projection = opencv_projection(matrices.with("P1"), "P1");
  calibration.right.projection = opencv_projection(matrices.with("P2"), "P2");
  if (calibration.left.projection(0, 3) != 0)
    matrices.with("P1").fail("P1", "expected P1(0,3) to be 0: the left camera is the origin");
  calibration.right.projection(0, 3) *= meters_per_unit;
}

void rectify(Matrices& matrices, StereoCalibration& calibration, double meters_per_unit) {
  const cv::Matx33d R_right_left = opencv_rotation(matrices.with("R"), "R");
  const cv::Vec3d t_right_m = opencv_translation(matrices.with("T"), "T") * meters_per_unit;
  if (!rectify_pair(calibration, R_right_left, t_right_m))
    matrices.with("R").fail("R", "expected two cameras that cv::stereoRectify brings side by side");
}

}  // namespace

bool looks_like_opencv(const std::string& text) {
  return is_xml(text) || text.starts_with("%YAML:1.0") || text.find("!!opencv-matrix") != std::string::npos;
}

StereoCalibration read_opencv_calibration(const fs::path& path, const CalibrationOptions& options) {
  Matrices matrices(path);
  StereoCalibration calibration;
  calibration.T_body_left = T_body_camera_of(Eigen::Vector3d::Zero(), 0);
  calibration.left.camera_matrix = opencv_camera_matrix(matrices.with("M1"), "M1");
  calibration.left.distortion = opencv_distortion(matrices.with("D1"), "D1");
  calibration.right.camera_matrix = opencv_camera_matrix(matrices.with("M2"), "M2");
  calibration.right.distortion = opencv_distortion(matrices.with("D2"), "D2");
  const ImageSize size = agreed_image_size(path.string(), size_in(matrices), options);
  calibration.width_px = size.width_px;
  calibration.height_px = size.height_px;
  // Where both are there, R and T say nothing more: these are what the rig's maker rectified with.
  const std::array<std::string, 4> rectified{"R1", "R2", "P1", "P2"};
  if (std::any_of(rectified.begin(), rectified.end(), [&](const auto& key) { return matrices.has(key); }))
    read_rectification(matrices, calibration, options.meters_per_unit);
  else
    rectify(matrices, calibration, options.meters_per_unit);
  return calibration;
}

}  // namespace understory
