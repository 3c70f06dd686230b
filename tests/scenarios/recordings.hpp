#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "perception/stereo_rig.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/recording/euroc_texts.hpp"
#include "scenarios/scenario/scenario_io.hpp"

/// What tests of recordings share.
namespace understory {

inline const std::filesystem::path root = UNDERSTORY_SOURCE_DIR;

inline Scenario library_scenario(const std::string& name, const std::vector<std::string>& settings = {}) {
  return load_scenario(root / "scenarios/library" / (name + ".yaml"), settings);
}

inline FlyOptions into(const std::filesystem::path& folder) {
  FlyOptions options;
  options.models_folder = root / "models";
  options.output_folder = folder;
  return options;
}

/// The image of "depth0", "objects0" ... that was recorded at t_ns of the flight.
inline cv::Mat image_of(const std::filesystem::path& recording, const char* sensor, std::int64_t t_ns) {
  const std::string name = std::to_string(recorded_ns(t_ns)) + ".png";
  return cv::imread((recording / "mav0" / sensor / "data" / name).string(), cv::IMREAD_UNCHANGED);
}

/// Through a pixel of the left image; its z is 1.
inline Eigen::Vector3d ray_of_pixel(const StereoRig& rig, int row, int column) {
  return {(column - rig.center_left_x_px) / rig.focal_px, (row - rig.center_y_px) / rig.focal_px, 1};
}

inline double apart_rad(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

}  // namespace understory
