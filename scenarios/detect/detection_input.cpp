#include "scenarios/detect/detection_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "perception/io/euroc_calibration.hpp"
#include "perception/io/pose_file.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/config/config_reader.hpp"
#include "scenarios/scenario/detection_depths.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// A calibration file that tells no size fits images of any: its principal point gives away a wrong one.
void check_principal_point(const StereoCalibration& calibration, const fs::path& rig) {
  const double u = calibration.left.camera_matrix(0, 2), v = calibration.left.camera_matrix(1, 2);
  const auto is_central = [](double place, int size) { return place > 0.3 * size && place < 0.7 * size; };
  if (is_central(u, calibration.width_px) && is_central(v, calibration.height_px)) return;
  const std::string size = fmt::format("{}x{}", calibration.width_px, calibration.height_px);
  throw std::runtime_error(fmt::format(
      "{}: expected a principal point in the middle of the {} images, found ({:.0f}, {:.0f}): calibrated at "
      "another resolution? (--size {} says it was not)",
      rig.string(), size, u, v, size));
}

/// As `file` tells it, where need be with the size of the images.
CalibratedRig read_rig_for(cv::Size images, const fs::path& file, CalibrationOptions options) {
  try {
    return read_calibrated_rig(file, options);
  } catch (const std::runtime_error&) {
    if (options.width_px) throw;
  }
  options.width_px = images.width;
  options.height_px = images.height;
  CalibratedRig camera = read_calibrated_rig(file, options);
  if (camera.calibration) check_principal_point(*camera.calibration, file);
  return camera;
}

}  // namespace

CalibratedRig rig_for(const DetectionOptions& options, const StereoRecording& recording) {
  const bool brings_its_own = options.inputs.size() == 1 && euroc_folder(options.inputs[0]).has_value();
  if (options.rig.empty() && !brings_its_own)
    throw ScenarioError(fmt::format("{}: expected a rig (--rig): only EuRoC folders bring their own",
                                    options.inputs.front().string()));
  const fs::path file = options.rig.empty() ? options.inputs[0] : options.rig;
  const cv::Size images = recording.image_size();
  const CalibratedRig camera =
      bad_input_if_refused([&] { return read_rig_for(images, file, options.calibration); });
  if (images != cv::Size(camera.rig.width_px, camera.rig.height_px))
    throw ScenarioError(fmt::format("{}: expected {}x{} as {} has, found {}x{}",
                                    recording.first_file().string(), camera.rig.width_px,
                                    camera.rig.height_px, file.string(), images.width, images.height));
  return camera;
}

DetectionConfig config_for(const DetectionOptions& options, const StereoRig& rig) {
  DetectionConfig config;
  config.pushbroom = options.rule;
  config.pushbroom.last_row_px = last_row_px_of(rig.height_px);
  for (const std::string& setting : options.settings) read_config(parse_assignment(setting), config);
  check_depths(config.pushbroom, rig, "depths_m", "pushbroom");
  return config;
}

std::optional<PosedMap> map_for(const DetectionOptions& options, const StereoRecording& recording,
                                const StereoRig& rig, const LocalMapConfig& config) {
  if (options.poses.empty()) return std::nullopt;
  auto poses = bad_input_if_refused([&] { return read_poses(options.poses); });
  const auto images = recording.times();
  if (!images)
    throw ScenarioError(fmt::format("--poses: expected images with times, found none in the names ({})",
                                    recording.first_file().string()));
  const auto seconds = [](std::int64_t t_ns) { return 1e-9 * static_cast<double>(t_ns); };
  const std::int64_t first_ns = poses.front().t_ns, last_ns = poses.back().t_ns;
  if (images->last_ns < first_ns || images->first_ns > last_ns)
    throw ScenarioError(
        fmt::format("{}: expected poses at the images' time, {:.3f} to {:.3f} s, found {:.3f} to {:.3f} s",
                    options.poses.string(), seconds(images->first_ns), seconds(images->last_ns),
                    seconds(first_ns), seconds(last_ns)));
  return PosedMap(std::move(poses), rig, config);
}

double film_rate_hz(const StereoRecording& recording) {
  constexpr double where_unknown_hz = 20, minimum_hz = 1, maximum_hz = 120;
  const auto times = recording.times();
  const std::int64_t count = recording.frame_count();
  if (!times || count < 2) return where_unknown_hz;
  const double span_s = 1e-9 * static_cast<double>(times->last_ns - times->first_ns);
  return std::clamp(static_cast<double>(count - 1) / span_s, minimum_hz, maximum_hz);
}

}  // namespace understory
