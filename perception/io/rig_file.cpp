#include "perception/io/rig_file.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace understory {
namespace {

/// One YAML map of scalars and lists, read key by key; says where it went wrong.
class StrictMap {
 public:
  StrictMap(std::string file, const YAML::Node& root) : file_(std::move(file)) {
    if (!root.IsMap()) fail(YAML::Mark(), "rig", "expected a map of keys");
    for (const auto& entry : root) {
      const auto key = entry.first.Scalar();
      if (!nodes_.emplace(key, entry.second).second)
        fail(entry.first.Mark(), key, "expected once, found again");
      marks_.emplace(key, entry.first.Mark());
    }
  }

  std::string text(const std::string& key) {
    const YAML::Node node = take(key);
    if (!node.IsScalar() || node.Scalar().empty()) fail(marks_.at(key), key, "expected text");
    return node.Scalar();
  }

  double number(const std::string& key, double least, double greatest) {
    return number(take(key), key, least, greatest);
  }

  int whole(const std::string& key, int least, int greatest) {
    const double value = number(key, least, greatest);
    if (value != std::floor(value)) fail(marks_.at(key), key, "expected a whole number");
    return static_cast<int>(value);
  }

  Eigen::Vector3d vector(const std::string& key, double least, double greatest) {
    const YAML::Node node = take(key);
    if (!node.IsSequence() || node.size() != 3) fail(marks_.at(key), key, "expected a list of three numbers");
    Eigen::Vector3d value;
    for (int i = 0; i < 3; ++i) value[i] = number(node[i], key, least, greatest);
    return value;
  }

  [[noreturn]] void fail_at(const std::string& key, const std::string& expected) const {
    fail(marks_.at(key), key, expected);
  }

  /// To be called once every known key was asked for.
  void refuse_others() const {
    for (const auto& [key, mark] : marks_)
      if (!taken_.count(key)) fail(mark, key, "unknown key; expected " + known());
  }

 private:
  YAML::Node take(const std::string& key) {
    taken_.insert(key);
    order_.push_back(key);
    const auto found = nodes_.find(key);
    if (found == nodes_.end()) {
      fail(YAML::Mark(), key, "expected this key, found none");
    }
    return found->second;
  }

  double number(const YAML::Node& node, const std::string& key, double least, double greatest) const {
    double value = 0;
    std::ostringstream expected;
    expected << "expected a number from " << least << " to " << greatest;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) ||
        !(value >= least && value <= greatest))
      fail(marks_.at(key), key, expected.str() + (node.IsScalar() ? ", found '" + node.Scalar() + "'" : ""));
    return value;
  }

  std::string known() const {
    std::string list;
    for (const auto& key : order_) list += (list.empty() ? "" : ", ") + key;
    return list;
  }

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& key, const std::string& expected) const {
    throw std::runtime_error(file_ + ":" + std::to_string(mark.is_null() ? 1 : mark.line + 1) + ": " + key +
                             ": " + expected);
  }

  std::string file_;
  std::map<std::string, YAML::Node> nodes_;
  std::map<std::string, YAML::Mark> marks_;
  std::set<std::string> taken_;
  std::vector<std::string> order_;
};

YAML::Node load(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    throw std::runtime_error(file.string() + ":1: rig: expected a readable file");
  try {
    return YAML::Load(stream);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(file.string() + ":" + std::to_string(error.mark.line + 1) +
                             ": rig: expected YAML: " + error.msg);
  }
}

}  // namespace

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
  StrictMap map(file.string(), load(file));
  StereoRig rig;
  rig.name = map.text("name");
  rig.width_px = map.whole("width_px", 32, 8192);
  rig.height_px = map.whole("height_px", 32, 8192);
  rig.focal_px = map.number("focal_px", 10, 20000);
  rig.baseline_m = map.number("baseline_m", 0.01, 10);
  rig.center_left_x_px = map.number("center_left_x_px", -8192, 16384);
  rig.center_right_x_px = map.number("center_right_x_px", -8192, 16384);
  rig.center_y_px = map.number("center_y_px", -8192, 16384);
  rig.detection_depth_m = map.number("detection_depth_m", 0.1, 1000);
  const Eigen::Vector3d left_camera_body_m = map.vector("left_camera_body_m", -10, 10);
  const double pitch_down_deg = map.number("pitch_down_deg", -90, 90);
  map.refuse_others();
  rig.T_body_camera = T_body_camera_of(left_camera_body_m, pitch_down_deg * std::numbers::pi / 180);

  const double disparity_px = std::round(rig.disparity_px(rig.detection_depth_m));
  if (disparity_px - rig.infinity_disparity_px() <= 1.0 || std::abs(disparity_px) > 0.9 * rig.width_px)
    map.fail_at("detection_depth_m",
                "expected a depth more than a pixel nearer than infinity and inside the image");
  return rig;
}

}  // namespace understory
