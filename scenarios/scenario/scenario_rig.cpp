#include "scenarios/scenario/scenario_rig.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// Both must describe the same cameras. A wrong unit of length or another rig's file is detected here.
void require_alike(const StereoRig& rectified, const StereoRig& rig, const fs::path& file) {
  const auto alike = [](double a, double b) { return std::abs(a - b) < 0.01 * b; };
  if (!alike(rectified.focal_px, rig.focal_px) || !alike(rectified.baseline_m, rig.baseline_m) ||
      rectified.width_px != rig.width_px || rectified.height_px != rig.height_px)
    throw std::runtime_error(
        fmt::format("{}: the cameras must be those of rig {}, {}x{} px, focal length {:.4g} px, baseline "
                    "{:.4g} m, they are {}x{} px, {:.4g} px, {:.4g} m",
                    file.string(), rig.name, rig.width_px, rig.height_px, rig.focal_px, rig.baseline_m,
                    rectified.width_px, rectified.height_px, rectified.focal_px, rectified.baseline_m));
}

CalibratedRig raw_rig(const fs::path& rig_file, const StereoRig& rig, double meters_per_unit) {
  const fs::path file = raw_file_of(rig_file);
  if (!fs::exists(file)) throw std::runtime_error("the rig's calibration is missing: " + file.string());
  CalibrationOptions options;
  options.meters_per_unit = meters_per_unit;
  options.detection_depth_m = rig.detection_depth_m;
  CalibratedRig raw = read_calibrated_rig(file, options);
  require_alike(raw.rig, rig, file);
  if (!raw.calibration) throw std::runtime_error(file.string() + ": these cameras give rectified images");
  Eigen::Matrix3d rectified_of_raw;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rectified_of_raw(i, j) = raw.calibration->left.rectification(i, j);
  raw.calibration->T_body_left = rig.T_body_camera;
  raw.calibration->T_body_left.linear() = rig.T_body_camera.linear() * rectified_of_raw;
  return {rectified_rig(*raw.calibration, rig.detection_depth_m), raw.calibration};
}

}  // namespace

std::vector<fs::path> rig_files_of(const Scenario& scenario, const fs::path& models_folder) {
  const fs::path named = models_folder / "rigs" / (scenario.rig + ".yaml");
  std::error_code ignored;
  const bool is_named = fs::exists(named, ignored);
  if (!is_named && !fs::exists(scenario.rig, ignored)) {
    throw ScenarioError(fmt::format("rig: must be a name in {} or a rig file, got {}",
                                    named.parent_path().string(), scenario.rig));
  }
  const fs::path file = is_named ? named : fs::path(scenario.rig);
  return files_of_rig(file, scenario.cameras.raw);
}

std::vector<fs::path> files_of_rig(const fs::path& file, bool raw) {
  return raw ? std::vector{file, raw_file_of(file)} : std::vector{file};
}

CalibratedRig rig_of(const Scenario& scenario, const fs::path& models_folder) {
  const fs::path file = rig_files_of(scenario, models_folder).front();
  try {
    const StereoRig rig = read_rig(file);
    if (!scenario.cameras.raw) return {rig, std::nullopt};
    try {
      return raw_rig(file, rig, scenario.cameras.raw_unit_m);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("cameras.raw: {} (unit: cameras.raw_unit_m)", error.what()));
    }
  } catch (const std::runtime_error& error) {
    throw ScenarioError(error.what());
  }
}

void check_depths(const PushbroomConfig& rule, const StereoRig& rig, const std::string& depths_key,
                  const std::string& section) {
  const std::string fault = fault_of(rule, rig);
  if (fault.empty()) return;
  constexpr std::string_view depths = "depths_m";
  throw ScenarioError(fault.starts_with("depths_m:") ? depths_key + fault.substr(depths.size())
                                                     : section + "." + fault);
}

}  // namespace understory
