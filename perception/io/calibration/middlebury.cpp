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

constexpr double metres_per_millimetre = 1e-3;

/// Lines "KEY=VALUE".
class Lines {
 public:
  Lines(const std::string& file, const std::string& text) : file_(file) {
    constexpr std::array<std::string_view, 12> known{"cam0",  "cam1",  "doffs", "baseline", "width", "height",
                                                     "ndisp", "isint", "vmin",  "vmax",     "dyavg", "dymax"};
    std::istringstream stream(text);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      const std::size_t equals = line.find('=');
      const std::string key = line.substr(0, equals), place = place_in(file, number);
      if (equals == std::string::npos || std::ranges::find(known, key) == known.end())
        refuse_input(place, key,
                     fmt::format("expected KEY=VALUE, with one of the keys {}", fmt::join(known, ", ")));
      if (!values_.try_emplace(key, place, line.substr(equals + 1)).second)
        refuse_input(place, key, "this key is given twice");
    }
  }

  double number(const std::string& key, double minimum, double maximum) const {
    const auto& [place, text] = value(key);
    const auto found = number_in<double>(text.substr(0, text.find_last_not_of(" \t\r") + 1));
    if (!found || !(*found >= minimum && *found <= maximum))
      refuse_input(place, key, fmt::format("must be a number from {} to {}", minimum, maximum));
    return *found;
  }

  /// "[f 0 cx; 0 f cy; 0 0 1]".
  cv::Matx33d camera(const std::string& key) const {
    const auto& [place, text] = value(key);
    std::string plain = text;
    std::ranges::replace_if(
        plain, [](char c) { return c == '[' || c == ']' || c == ';'; }, ' ');
    std::istringstream words(plain);
    std::vector<double> values;
    for (std::string word; words >> word;) values.push_back(number_in<double>(word).value_or(NAN));
    const bool is_camera = values.size() == 9 && values[0] == values[4] && values[1] == 0 && values[3] == 0 &&
                           values[6] == 0 && values[7] == 0 && values[8] == 1 && std::isfinite(values[2]) &&
                           std::isfinite(values[5]);
    if (!is_camera) refuse_input(place, key, "must have the form [f 0 cx; 0 f cy; 0 0 1]");
    return cv::Matx33d(values.data());
  }

  [[noreturn]] void fail(const std::string& key, const std::string& expected) const {
    refuse_input(value(key).first, key, expected);
  }

 private:
  const std::pair<std::string, std::string>& value(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) refuse_input(file_, key, "missing");
    return found->second;
  }

  std::string file_;
  std::map<std::string, std::pair<std::string, std::string>> values_;  ///< place and text
};

}  // namespace

StereoRig read_middlebury_calibration(const std::filesystem::path& path, const CalibrationOptions& options) {
  using namespace rig_limits;
  const std::string file = path.string();
  require_metres(file, "Middlebury's calibration, whose baseline is in mm,", options);
  const Lines lines(file, calibration_text(path));
  const cv::Matx33d left = lines.camera("cam0"), right = lines.camera("cam1");
  if (left(0, 0) != right(0, 0) || left(1, 2) != right(1, 2))
    lines.fail("cam1", "must have the focal length and the row of cam0: the pair is rectified");
  if (std::abs(right(0, 2) - left(0, 2) - lines.number("doffs", -1e4, 1e4)) > 0.01)
    lines.fail("doffs", "must be the column of cam1's principal point less cam0's");
  const ImageSize said{static_cast<int>(lines.number("width", minimum_size_px, maximum_size_px)),
                       static_cast<int>(lines.number("height", minimum_size_px, maximum_size_px))};
  const ImageSize size = agreed_image_size(file, said, options);
  StereoRig rig;
  rig.width_px = size.width_px;
  rig.height_px = size.height_px;
  rig.focal_px = left(0, 0);
  rig.baseline_m = metres_per_millimetre * lines.number("baseline", 1, 1e5);
  rig.center_left_x_px = left(0, 2);
  rig.center_right_x_px = right(0, 2);
  rig.center_y_px = left(1, 2);
  rig.T_body_camera = T_body_camera_of(Eigen::Vector3d::Zero(), 0);
  return rig;
}

}  // namespace understory
