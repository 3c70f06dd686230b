#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/persistence.hpp>
#include <vector>

#include "perception/io/calibration/calibration_forms.hpp"
#include "perception/io/strict_map.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using namespace rig_limits;

constexpr double coefficient_tolerance = 1e-9;  // what counts as 0

struct Matrix {
  int rows = 0, cols = 0;
  std::vector<double> values;  // row by row
};

constexpr std::string_view json_mark = "$base64$";

/// Whether the data are bytes, as cv::FileStorage::WRITE_BASE64 makes them.
bool is_base64(StrictMap& fields) {
  return fields.type("data") == "binary" || fields.joined_text("data").starts_with(json_mark);
}

/// By OpenCV's own reader, which is given the matrix alone, after its size and its head are known.
std::vector<double> from_base64(StrictMap& fields, const std::string& type, std::size_t count) {
  std::string bytes = fields.joined_text("data");
  if (bytes.starts_with(json_mark)) bytes.erase(0, json_mark.size());
  std::erase_if(bytes, [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; });
  constexpr std::size_t head_bytes = 24;  // "1d" and blanks, which is this in base64
  std::string head = type == "d" ? "MWQg" : "MWYg";
  while (head.size() < head_bytes / 3 * 4) head += "ICAg";
  const std::size_t all_bytes = head_bytes + count * (type == "d" ? sizeof(double) : sizeof(float));
  const bool is_plain = bytes.find_first_not_of(
                            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                            "0123456789+/=") == std::string::npos;
  if (!is_plain || !bytes.starts_with(head) || bytes.size() != (all_bytes + 2) / 3 * 4)
    fields.fail("data",
                fmt::format("must be {} numbers of type {} in base64, as OpenCV writes them", count, type));
  cv::Mat read;
  try {
    const cv::FileStorage storage(
        fmt::format("%YAML:1.0\n---\nm: !!opencv-matrix\n   rows: {}\n   cols: 1\n   dt: {}\n"
                    "   data: !!binary |\n      {}\n",
                    count, type, bytes),
        cv::FileStorage::READ | cv::FileStorage::MEMORY);
    storage["m"] >> read;
    read.convertTo(read, CV_64F);
  } catch (const cv::Exception&) {
    read.release();
  }
  const std::vector<double> values(read.begin<double>(), read.end<double>());
  if (values.size() != count) fields.fail("data", "its base64 is broken");
  for (const double value : values)
    if (!(std::abs(value) <= maximum_entry))
      fields.fail("data", fmt::format("must be numbers within +-{}, one is {}", maximum_entry, value));
  return values;
}

Matrix matrix(StrictMap& map, const std::string& key) {
  constexpr int maximum_side = 16;
  StrictMap fields = map.map(key);
  const std::string kind =
      fields.has("type_id") ? fields.text("type_id") : map.type(key);  // JSON has no tags
  if (kind != "opencv-matrix") map.fail(key, "must be an OpenCV matrix (opencv-matrix)");
  Matrix matrix;
  matrix.rows = fields.whole("rows", 0, maximum_side);
  matrix.cols = fields.whole("cols", 0, maximum_side);
  const std::string type = fields.text("dt");
  if (type != "d" && type != "f") fields.fail("dt", "must be d or f, is '" + type + "'");
  const auto count = static_cast<std::size_t>(matrix.rows * matrix.cols);
  matrix.values = is_base64(fields) ? from_base64(fields, type, count)
                                    : fields.numbers("data", count, -maximum_entry, maximum_entry);
  return matrix;
}

template <int rows, int cols>
cv::Matx<double, rows, cols> matrix_of_shape(StrictMap& map, const std::string& key) {
  const Matrix found = matrix(map, key);
  if (found.rows != rows || found.cols != cols)
    map.fail(key, fmt::format("must have {} x {} numbers, has {} x {}", rows, cols, found.rows, found.cols));
  return cv::Matx<double, rows, cols>(found.values.data());
}

/// 3x3.
cv::Matx33d opencv_rotation(StrictMap& map, const std::string& key) {
  const auto rotation = matrix_of_shape<3, 3>(map, key);
  require_rotation(map, key, rotation);
  return rotation;
}

/// 3x3: fx 0 cx, 0 fy cy, 0 0 1.
cv::Matx33d opencv_camera_matrix(StrictMap& map, const std::string& key) {
  const auto camera = matrix_of_shape<3, 3>(map, key);
  require_camera_matrix(map, key, camera);
  return camera;
}

/// 3x4: f 0 cx t, 0 f cy 0, 0 0 1 0; t in focal lengths times the file's unit.
cv::Matx34d opencv_projection(StrictMap& map, const std::string& key) {
  const auto projection = matrix_of_shape<3, 4>(map, key);
  require_projection(map, key, projection);
  return projection;
}

/// 3x1 or 1x3, in the file's unit.
cv::Vec3d opencv_translation(StrictMap& map, const std::string& key) {
  const Matrix found = matrix(map, key);
  if (std::min(found.rows, found.cols) != 1 || std::max(found.rows, found.cols) != 3)
    map.fail(key, fmt::format("must have 3 x 1 numbers, has {} x {}", found.rows, found.cols));
  return cv::Vec3d(found.values.data());
}

/// None, 4, 5 or 8 coefficients in a row or a column; 12 or 14 where those past the 8th are 0, as
/// cv::stereoCalibrate leaves them.
std::vector<double> opencv_distortion(StrictMap& map, const std::string& key) {
  constexpr std::size_t maximum_count = 8;
  Matrix found = matrix(map, key);
  const std::size_t count = found.values.size();
  if (count == 0) return {};
  const bool is_count = count == 4 || count == 5 || count == 8 || count == 12 || count == 14;
  if (std::min(found.rows, found.cols) != 1 || !is_count)
    map.fail(key,
             fmt::format("must be 4, 5 or 8 coefficients in a row, has {} x {}", found.rows, found.cols));
  for (const double coefficient : found.values)
    if (std::abs(coefficient) > maximum_coefficient)
      map.fail(key,
               fmt::format("coefficients must be within +-{}, one is {}", maximum_coefficient, coefficient));
  for (std::size_t i = maximum_count; i < count; ++i)
    if (std::abs(found.values[i]) > coefficient_tolerance)
      map.fail(key, "only 4, 5 or 8 coefficients are supported: no thin prisms, no tilted sensors");
  found.values.resize(std::min(count, maximum_count));
  return found.values;
}

bool is_xml(const std::string& text) {
  const std::size_t first = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  return first != std::string::npos && text[first] == '<';
}

TextNode read_tree(const fs::path& file) {
  const std::string text = calibration_text(file), name = file.string();
  return is_xml(text) ? parse_opencv_xml(text, name) : parse_yaml(text, name);
}

/// The keys of the file, or of all the folder's files.
StrictMap read_keys(const fs::path& path) {
  std::error_code ignored;
  const bool is_folder = fs::is_directory(path, ignored);
  TextNode all;
  if (!is_folder) all = read_tree(path);
  all.kind = TextNode::Kind::map;
  all.origin = path.string();
  if (!is_folder) return StrictMap(all);
  for (const std::string name :
       {"intrinsics", "extrinsics", "M1", "D1", "R1", "P1", "M2", "D2", "R2", "P2", "R", "T"})
    for (const char* extension : {".xml", ".yml", ".yaml", ".json", ".xml.gz", ".yml.gz"})
      if (const fs::path file = path / (name + extension); fs::exists(file, ignored))
        for (TextNode& child : read_tree(file).children) all.children.push_back(std::move(child));
  if (all.children.empty())
    refuse_input(path.string(), "",
                 "holds no calibration: expected cam0 and cam1 of EuRoC, M1.xml, D1.xml and so on of OpenCV, "
                 "left.yaml and right.yaml of ROS, or one file of another form");
  refuse_double_keys(all);
  const StrictMap keys(all);
  for (const char* key : {"M1", "D1", "M2", "D2"})
    if (!keys.has(key))
      keys.fail(key, fmt::format("missing: it stands in {0}.xml, {0}.yml or {0}.yaml", key));
  return keys;
}

std::optional<ImageSize> size_in(StrictMap& keys) {
  if (!keys.has("image_width") && !keys.has("image_height")) return std::nullopt;
  return ImageSize{keys.whole("image_width", minimum_size_px, maximum_size_px),
                   keys.whole("image_height", minimum_size_px, maximum_size_px)};
}

/// A calibration that states no size fits images of any size: its principal point gives away a wrong one.
void check_principal_point(StrictMap& keys, const cv::Matx33d& camera_matrix, const ImageSize& size) {
  const double u = camera_matrix(0, 2), v = camera_matrix(1, 2);
  const auto is_central = [](double place, int size_px) {
    return place > 0.3 * size_px && place < 0.7 * size_px;
  };
  if (!is_central(u, size.width_px) || !is_central(v, size.height_px))
    keys.fail("M1", fmt::format("the principal point must lie near the middle of the {0}x{1} images, is "
                                "({2:.0f}, {3:.0f}): calibrated at another resolution? (--size {0}x{1} says "
                                "it was not)",
                                size.width_px, size.height_px, u, v));
}

void read_rectification(StrictMap& keys, StereoCalibration& calibration, double meters_per_unit) {
  calibration.left.rectification = opencv_rotation(keys, "R1");
  calibration.right.rectification = opencv_rotation(keys, "R2");
  calibration.left.projection = opencv_projection(keys, "P1");
  calibration.right.projection = opencv_projection(keys, "P2");
  if (calibration.left.projection(0, 3) != 0)
    keys.fail("P1", "P1(0,3) must be 0: the left camera is the origin");
  calibration.right.projection(0, 3) *= meters_per_unit;
}

void rectify(StrictMap& keys, StereoCalibration& calibration, double meters_per_unit) {
  const cv::Matx33d R_right_left = opencv_rotation(keys, "R");
  const cv::Vec3d t_right_m = opencv_translation(keys, "T") * meters_per_unit;
  rectify_pair(calibration, R_right_left, t_right_m, keys, "T");
}

/// Which lens D1 and D2 are of: a fisheye's numbers look like another's, so files of cv::fisheye say it.
LensModel lens_in(StrictMap& keys) {
  constexpr LensModel bent = LensModel::radial_tangential, wide = LensModel::equidistant;
  constexpr std::array<LensWord, 4> flags{{{"0", bent}, {"false", bent}, {"1", wide}, {"true", wide}}};
  constexpr std::array<LensWord, 2> cameras{{{"pinhole", bent}, {"fisheye", wide}}};
  constexpr std::array<LensWord, 6> lenses{{{"radial-tangential", bent},
                                            {"radtan", bent},
                                            {"plumb_bob", bent},
                                            {"rational_polynomial", bent},
                                            {"equidistant", wide},
                                            {"fisheye", wide}}};
  LensModel lens = bent;
  const auto look_for = [&](const char* key, std::span<const LensWord> words) {
    if (keys.has(key) && lens_model(keys, key, words) == wide) lens = wide;
  };
  look_for("fisheye_model", flags);
  look_for("camera_model", cameras);
  look_for("distortion_model", lenses);
  return lens;
}

/// What programs write for the record beside the matrices changes nothing; all else might.
void check_other_keys(StrictMap& keys) {
  keys.refuse_others(
      " R T E F Q image_width image_height calibration_time date time name comment nframes board_width "
      "board_height square_size marker_size flags avg_reprojection_error per_view_reprojection_errors rms "
      "rms_error epipolar_error extrinsic_parameters image_points grid_points validRoi1 validRoi2 views ");
}

}  // namespace

bool looks_like_opencv(const std::string& text) {
  return is_xml(text) || text.starts_with("%YAML:1.0") || text.find("opencv-matrix") != std::string::npos;
}

StereoCalibration read_opencv_calibration(const fs::path& path, const CalibrationOptions& options) {
  StrictMap keys = read_keys(path);
  StereoCalibration calibration;
  calibration.T_body_left = T_body_camera_of(Eigen::Vector3d::Zero(), 0);
  calibration.left.camera_matrix = opencv_camera_matrix(keys, "M1");
  calibration.left.distortion = opencv_distortion(keys, "D1");
  calibration.right.camera_matrix = opencv_camera_matrix(keys, "M2");
  calibration.right.distortion = opencv_distortion(keys, "D2");
  calibration.left.lens = calibration.right.lens = lens_in(keys);
  for (const auto& [key, camera] : {std::pair("D1", &calibration.left), {"D2", &calibration.right}})
    if (camera->lens == LensModel::equidistant && camera->distortion.size() != 4)
      keys.fail(key, "must be the 4 coefficients of a fisheye lens, as the file says that it is one");
  const std::optional<ImageSize> of_file = size_in(keys);
  const ImageSize size = agreed_image_size(path.string(), of_file, options);
  if (!of_file && !options.width_px) check_principal_point(keys, calibration.left.camera_matrix, size);
  calibration.width_px = size.width_px;
  calibration.height_px = size.height_px;
  const double unit_m = options.meters_per_unit.value_or(1);
  // Where both are there, R and T say nothing more: these are what the rig's maker rectified with.
  const std::array<std::string, 4> rectified{"R1", "R2", "P1", "P2"};
  if (std::any_of(rectified.begin(), rectified.end(), [&](const auto& key) { return keys.has(key); }))
    read_rectification(keys, calibration, unit_m);
  else
    rectify(keys, calibration, unit_m);
  check_other_keys(keys);
  return calibration;
}

}  // namespace understory
