#pragma once

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "perception/stereo_frame.hpp"
#include "tests/support/synthetic_stereo.hpp"

namespace understory::support {

/// Writes pairs as <folder>/left/<name>.png and <folder>/right/<name>.png.
inline void write_pairs(const std::filesystem::path& folder, const std::vector<StereoFrame>& frames,
                        const std::vector<std::string>& names) {
  std::filesystem::create_directories(folder / "left");
  std::filesystem::create_directories(folder / "right");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    cv::imwrite((folder / "left" / (names[i] + ".png")).string(), frames[i].left);
    cv::imwrite((folder / "right" / (names[i] + ".png")).string(), frames[i].right);
  }
}

/// Planes of different texture, `away_m` behind the rig's detection depth.
inline std::vector<StereoFrame> planes(const StereoRig& rig, std::size_t count, double away_m = 0) {
  std::vector<StereoFrame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    SyntheticPlane plane;
    plane.depth_m = rig.detection_depth_m + away_m;
    plane.seed = 100 + i;
    frames.push_back(render_plane(rig, plane));
  }
  return frames;
}

}  // namespace understory::support
