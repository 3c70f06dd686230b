#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "perception/io/calibration/calibration_forms.hpp"
#include "perception/io/text_file.hpp"
#include "perception/io/text_table.hpp"

namespace understory {
namespace {

using namespace rig_limits;

/// A line "KEY: number number ...".
struct Line {
  std::string place;
  std::vector<std::string> words;
};

std::map<std::string, Line> lines_of(const std::string& file, const std::string& text) {
  // Of calib.txt, its kinds for odometry and for objects, and of calib_cam_to_cam.txt.
  constexpr std::array<std::string_view, 17> known{
      "Tr",         "Tr_velo_cam", "P", "P_rect", "S_rect",  "R_rect",         "R0_rect",        "S",
      "K",          "D",           "R", "T",      "Tr_velo", "Tr_velo_to_cam", "Tr_imu_to_velo", "calib_time",
      "corner_dist"};
  std::map<std::string, Line> lines;
  std::istringstream stream(text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string place = place_in(file, number);
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) refuse_input(place, "", "expected KEY: and numbers");
    const std::string key = line.substr(0, colon);
    const std::string kind = key.substr(0, key.find_last_not_of("0123456789") + 1);
    const std::string plain = kind.ends_with('_') ? kind.substr(0, kind.size() - 1) : kind;
    if (std::ranges::find(known, plain) == known.end() && std::ranges::find(known, key) == known.end())
      refuse_input(place, key, "a calibration of KITTI's has no such key");
    std::istringstream words(line.substr(colon + 1));
    Line& its = lines[key];
    if (!its.place.empty()) refuse_input(place, key, "this key is given twice");
    its.place = place;
    for (std::string word; words >> word;) its.words.push_back(word);
  }
  return lines;
}

std::vector<double> numbers(const std::map<std::string, Line>& lines, const std::string& key,
                            std::size_t count) {
  const Line& line = lines.at(key);
  std::vector<double> values;
  for (const std::string& word : line.words) {
    const auto value = number_in<double>(word);
    if (!value || !std::isfinite(*value))
      refuse_input(line.place, key, "must be a number, found '" + word + "'");
    values.push_back(*value);
  }
  if (values.size() != count)
    refuse_input(line.place, key, fmt::format("must be {} numbers, found {}", count, values.size()));
  return values;
}

}  // namespace

StereoRig read_kitti_calibration(const std::filesystem::path& path, const CalibrationOptions& options) {
  const std::string file = path.string();
  require_metres(file, "KITTI's calibration", options);
  const std::map<std::string, Line> lines = lines_of(file, calibration_text(path));
  using Pair = std::array<std::string, 2>;
  const std::array<Pair, 4> pairs{
      {{"P_rect_00", "P_rect_01"}, {"P0", "P1"}, {"P_rect_02", "P_rect_03"}, {"P2", "P3"}}};
  const std::size_t first = options.of_colour_pair ? 2 : 0;
  const auto pair = std::find_if(pairs.begin() + first, pairs.end(), [&](const Pair& one) {
    return lines.contains(one[0]) && lines.contains(one[1]);
  });
  if (pair == pairs.end()) refuse_input(file, "P0", "missing, with P1: the cameras' projections");
  const cv::Matx34d left(numbers(lines, (*pair)[0], 12).data()), right(numbers(lines, (*pair)[1], 12).data());
  std::optional<ImageSize> size;
  if (const std::string key = "S_rect_" + (*pair)[0].substr((*pair)[0].size() - 2); lines.contains(key)) {
    const std::vector<double> said = numbers(lines, key, 2);
    for (const double side : said)
      if (side != std::floor(side) || side < minimum_size_px || side > maximum_size_px)
        refuse_input(lines.at(key).place, key,
                     fmt::format("must be whole numbers from {} to {}", minimum_size_px, maximum_size_px));
    size = ImageSize{static_cast<int>(said[0]), static_cast<int>(said[1])};
  }
  const ImageSize agreed = agreed_image_size(file, size, options);
  StereoCalibration calibration;
  calibration.name = file;
  calibration.width_px = agreed.width_px;
  calibration.height_px = agreed.height_px;
  calibration.left.projection = left;
  calibration.right.projection = right;
  calibration.right.projection(0, 3) -= left(0, 3);  // the colour cameras are counted from the gray left one
  calibration.T_body_left = T_body_camera_of(Eigen::Vector3d::Zero(), 0);
  return rectified_rig(calibration, 10);
}

}  // namespace understory
