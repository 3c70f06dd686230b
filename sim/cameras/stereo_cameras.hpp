#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "perception/stereo_calibration.hpp"
#include "perception/stereo_frame.hpp"
#include "perception/stereo_rig.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/cameras/camera_config.hpp"
#include "sim/render/eye.hpp"
#include "sim/render/renderer_kind.hpp"
#include "sim/scene/world.hpp"

namespace understory {

/// Seeds of a camera pair's generators.
struct CameraSeeds {
  std::uint64_t noise = 0;
  std::uint64_t shot = 0;
};

/// A camera that follows the aircraft a little behind and above, level, for people.
Eye chase_eye(const Eigen::Isometry3d& T_world_body, int width_px, int height_px);

/// Renders both eyes of a rig offscreen (OSMesa or EGL, loaded at run time; in software bit-reproducible on
/// one machine).
class StereoCameras {
 public:
  /// Throws std::runtime_error in one line where no GL library can be loaded. Not thread safe; create and use
  /// on one thread. Without `raw` images are rectified, as `rig` describes. With `raw` they are those of the
  /// raw cameras, and `rig` must be rectified_rig(*raw). Paints the textures of the world's model.
  StereoCameras(const World& world, const StereoRig& rig, const CameraConfig& config, CameraSeeds seeds,
                const std::optional<StereoCalibration>& raw = std::nullopt,
                RendererKind renderer = RendererKind::osmesa);
  ~StereoCameras();

  /// Takes the body's pose at every physics step. Images with an exposure time are made of these poses.
  void observe(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns);
  /// Both images, gray 8-bit with noise, with the body at this pose and the exposure's end at t_ns; the
  /// frame's own time is CameraConfig::exposure_lag_ns() earlier.
  StereoFrame capture(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns);
  /// From now on other noise.
  void redraw(CameraSeeds seeds);
  /// Depth in the left image, rectified, with the body at this pose: CV_32FC1, metres along the optical axis.
  cv::Mat depth(const Eigen::Isometry3d& T_world_body) const;
  /// The true view of the left image, rectified, with the body at this pose: the same depth, and the objects.
  TrueView true_view(const Eigen::Isometry3d& T_world_body) const;
  /// What chase_eye() sees, BGR 8-bit. Of `truth` it takes the pose and the elevons.
  cv::Mat chase_view(const Truth& truth, int width_px, int height_px) const;
  /// The renderer's own name and version, for records.
  std::string renderer() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace understory
