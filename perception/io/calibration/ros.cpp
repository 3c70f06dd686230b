#include <fmt/format.h>

#include <array>
#include <utility>

#include "perception/io/calibration/calibration_forms.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

using namespace rig_limits;

template <int rows, int cols>
cv::Matx<double, rows, cols> matrix(StrictMap& map, const std::string& key) {
  StrictMap fields = map.map(key);
  fields.whole("rows", rows, rows);
  fields.whole("cols", cols, cols);
  const auto values = fields.numbers("data", rows * cols, -maximum_entry, maximum_entry);
  fields.refuse_others();
  return cv::Matx<double, rows, cols>(values.data());
}

std::vector<double> coefficients(StrictMap& map, const std::string& key, const std::string& model) {
  const int count = model == "rational_polynomial" ? 8 : model == "equidistant" ? 4 : 5;
  StrictMap fields = map.map(key);
  fields.whole("rows", 1, 1);
  fields.whole("cols", count, count);
  return fields.numbers("data", static_cast<std::size_t>(count), -maximum_coefficient, maximum_coefficient);
}

/// Nothing of the sensor may be left out or put together: calibrations are of the whole image.
void require_whole_image(StrictMap& map) {
  for (const char* key : {"binning_x", "binning_y"})
    if (map.has(key)) map.whole(key, 0, 1);
  if (!map.has("roi")) return;
  StrictMap roi = map.map("roi");
  for (const char* key : {"x_offset", "y_offset", "height", "width"})
    if (roi.has(key)) roi.whole(key, 0, 0);
}

RawCamera read_camera(const std::filesystem::path& file) {
  constexpr std::array<LensWord, 3> words{{{"plumb_bob", LensModel::radial_tangential},
                                           {"rational_polynomial", LensModel::radial_tangential},
                                           {"equidistant", LensModel::equidistant}}};
  RawCamera camera{StrictMap(parse_yaml(calibration_text(file), file.string())), {}, {}};
  StrictMap& map = camera.map;
  CameraCalibration& its = camera.calibration;
  camera.size = {map.whole("image_width", minimum_size_px, maximum_size_px),
                 map.whole("image_height", minimum_size_px, maximum_size_px)};
  its.camera_matrix = matrix<3, 3>(map, "camera_matrix");
  require_camera_matrix(map, "camera_matrix", its.camera_matrix);
  its.lens = lens_model(map, "distortion_model", words);
  its.distortion = coefficients(map, "distortion_coefficients", map.text("distortion_model"));
  its.rectification = matrix<3, 3>(map, "rectification_matrix");
  require_rotation(map, "rectification_matrix", its.rectification);
  its.projection = matrix<3, 4>(map, "projection_matrix");
  require_projection(map, "projection_matrix", its.projection);
  require_whole_image(map);
  map.refuse_others(" camera_name header D K R P height width ");
  return camera;
}

}  // namespace

StereoCalibration read_ros_calibration(const std::array<std::filesystem::path, 2>& files,
                                       const CalibrationOptions& options) {
  RawCamera left = read_camera(files[0]), right = read_camera(files[1]);
  if (left.calibration.projection(0, 3) != 0) std::swap(left, right);
  if (left.calibration.projection(0, 3) != 0)
    left.map.fail("projection_matrix", "its (0, 3) must be 0 for the left camera: here it is for neither");
  right.calibration.projection(0, 3) *= options.meters_per_unit.value_or(1);
  return raw_pair(left, right, files[0].string(), "image_width", options);
}

}  // namespace understory
