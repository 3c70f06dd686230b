#pragma once

#include <cstdint>

#include "perception/stereo_frame.hpp"
#include "perception/stereo_rig.hpp"

namespace understory::support {

/// A plane square to the optical axis, textured with smooth random brightness at two scales, as bark is.
struct SyntheticPlane {
  double depth_m = 5;
  double grain_px = 2.5;         ///< size of the texture's fine grain as it appears in the image
  double contrast = 68;          ///< its maximum deviation from mid gray
  double coarse_grain_px = 28;   ///< the coarse grain, which keeps distant places from looking alike
  double coarse_contrast = 500;  ///< more than the camera's range: part of the plane is black or white
  double noise_gray_levels = 2;  ///< standard deviation of each image's own sensor noise
  double repeats_every_px = 0;   ///< where positive, the texture repeats along the row with this period
  std::uint64_t seed = 1;
};

/// Both eyes' view of the plane, each pixel by the rig's own formula, the texture evaluated between its
/// grains.
StereoFrame render_plane(const StereoRig& rig, const SyntheticPlane& plane);

}  // namespace understory::support
