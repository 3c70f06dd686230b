#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "perception/stereo_frame.hpp"
#include "perception/stereo_rig.hpp"
#include "sim/world.hpp"

namespace understory {

struct CameraConfig {
  bool lens_cap = false;    ///< black images (proof against self-deception); noise still applies
  double noise_gray = 2.0;  ///< standard deviation of the sensor noise, gray levels, independent per pixel
  double view_distance_m =
      40;  ///< obstacles farther away than this are not drawn (they are a pixel or two wide)
};

template <typename Visitor>
void visit_fields(Visitor& visit, CameraConfig& config) {
  visit("lens_cap", config.lens_cap);
  visit("noise_gray", config.noise_gray, 0.0, 50.0);
  visit("view_distance_m", config.view_distance_m, 5.0, 200.0);
}

/// Renders both eyes of a rig offscreen (OSMesa, loaded at run time; software, bit-reproducible on one
/// machine).
class StereoCameras {
 public:
  /// Throws std::runtime_error in one line where no GL library can be loaded. `noise_seed` seeds this camera
  /// pair's own generator. Not thread safe; create and use on one thread.
  StereoCameras(const World& world, const StereoRig& rig, const CameraConfig& config,
                std::uint64_t noise_seed);
  ~StereoCameras();

  /// Both images, gray 8-bit with noise, as the cameras see the world of `data` now.
  StereoFrame capture(const mjData& data, std::int64_t t_ns);
  /// Depth of the left camera's newest capture-like view of `data`: CV_32FC1, metres along the optical axis.
  cv::Mat depth(const mjData& data);
  /// What a camera following the aircraft sees, BGR 8-bit, for people.
  cv::Mat chase_view(const mjData& data, int width_px, int height_px);
  /// The renderer's own name and version, for records.
  std::string renderer() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace understory
