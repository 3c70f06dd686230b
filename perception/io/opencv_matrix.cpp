#include "perception/io/opencv_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "perception/io/rig_limits.hpp"

namespace understory {
namespace {

constexpr double maximum_value = 1e9;           // of anything: focal lengths times millimetres stay far below
constexpr double maximum_coefficient = 1e4;     // wild calibrations reach 13 (the paper's rig)
constexpr double rotation_tolerance = 1e-3;     // files rounded by hand
constexpr double coefficient_tolerance = 1e-9;  // what counts as 0

struct Matrix {
  int rows = 0, cols = 0;
  std::vector<double> values;  // row by row
};

Matrix matrix(StrictMap& map, const std::string& key) {
  constexpr int maximum_side = 16;
  if (map.type(key) != "opencv-matrix") map.fail(key, "expected an OpenCV matrix (opencv-matrix)");
  StrictMap fields = map.map(key);
  Matrix matrix;
  matrix.rows = fields.whole("rows", 0, maximum_side);
  matrix.cols = fields.whole("cols", 0, maximum_side);
  const std::string type = fields.text("dt");
  if (type != "d" && type != "f") fields.fail("dt", "expected d or f, found '" + type + "'");
  const auto count = static_cast<std::size_t>(matrix.rows * matrix.cols);
  matrix.values = fields.numbers("data", count, -maximum_value, maximum_value);
  return matrix;
}

template <int rows, int cols>
cv::Matx<double, rows, cols> matrix_of_shape(StrictMap& map, const std::string& key) {
  const Matrix found = matrix(map, key);
  if (found.rows != rows || found.cols != cols)
    map.fail(key, fmt::format("expected {} x {} numbers, found {} x {}", rows, cols, found.rows, found.cols));
  return cv::Matx<double, rows, cols>(found.values.data());
}

bool in_range(double value, double minimum, double maximum) { return value >= minimum && value <= maximum; }

}  // namespace

cv::Matx33d opencv_rotation(StrictMap& map, const std::string& key) {
  const auto rotation = matrix_of_shape<3, 3>(map, key);
  const double departure = cv::norm(rotation * rotation.t() - cv::Matx33d::eye(), cv::NORM_INF);
  if (departure > rotation_tolerance || cv::determinant(rotation) < 0)
    map.fail(key, "expected a rotation: orthonormal, determinant 1");
  return rotation;
}

cv::Matx33d opencv_camera_matrix(StrictMap& map, const std::string& key) {
  using namespace rig_limits;
  const auto camera = matrix_of_shape<3, 3>(map, key);
  if (camera(0, 1) != 0 || camera(1, 0) != 0 || camera(2, 0) != 0 || camera(2, 1) != 0 || camera(2, 2) != 1)
    map.fail(key, "expected the form fx 0 cx, 0 fy cy, 0 0 1");
  for (const double focal_px : {camera(0, 0), camera(1, 1)})
    if (!in_range(focal_px, minimum_focal_px, maximum_focal_px))
      map.fail(key, fmt::format("expected focal lengths from {} to {} px, found {}", minimum_focal_px,
                                maximum_focal_px, focal_px));
  for (const double center_px : {camera(0, 2), camera(1, 2)})
    if (!in_range(center_px, minimum_center_px, maximum_center_px))
      map.fail(key, fmt::format("expected a principal point from {} to {} px, found {}", minimum_center_px,
                                maximum_center_px, center_px));
  return camera;
}

cv::Matx34d opencv_projection(StrictMap& map, const std::string& key) {
  const auto projection = matrix_of_shape<3, 4>(map, key);
  const bool has_form = projection(0, 1) == 0 && projection(1, 0) == 0 && projection(1, 3) == 0 &&
                        projection.row(2) == cv::Matx14d(0, 0, 1, 0);
  if (!has_form)
    map.fail(key, "expected the form f 0 cx t, 0 f cy 0, 0 0 1 0: cameras side by side, rectified");
  return projection;
}

cv::Vec3d opencv_translation(StrictMap& map, const std::string& key) {
  const Matrix found = matrix(map, key);
  if (std::min(found.rows, found.cols) != 1 || std::max(found.rows, found.cols) != 3)
    map.fail(key, fmt::format("expected 3 x 1 numbers, found {} x {}", found.rows, found.cols));
  return cv::Vec3d(found.values.data());
}

std::vector<double> opencv_distortion(StrictMap& map, const std::string& key) {
  constexpr std::size_t maximum_count = 8;
  Matrix found = matrix(map, key);
  const std::size_t count = found.values.size();
  if (count == 0) return {};
  const bool is_count = count == 4 || count == 5 || count == 8 || count == 12 || count == 14;
  if (std::min(found.rows, found.cols) != 1 || !is_count)
    map.fail(key,
             fmt::format("expected 4, 5 or 8 coefficients in a row, found {} x {}", found.rows, found.cols));
  for (const double coefficient : found.values)
    if (std::abs(coefficient) > maximum_coefficient)
      map.fail(key,
               fmt::format("expected coefficients within +-{}, found {}", maximum_coefficient, coefficient));
  for (std::size_t i = maximum_count; i < count; ++i)
    if (std::abs(found.values[i]) > coefficient_tolerance)
      map.fail(key, "expected 4, 5 or 8 coefficients: thin prisms and tilted sensors are not supported");
  found.values.resize(std::min(count, maximum_count));
  return found.values;
}

}  // namespace understory
