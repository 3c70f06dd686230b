#pragma once

#include <cstdint>
#include <vector>

#include "perception/io/calibration_file.hpp"
#include "perception/stereo_frame.hpp"

namespace understory {

/// Pairs as a flight through a forest gives them, rendered by ray casting without any simulator: trunks from
/// 2 to 40 m, ground, sky, bark and soil textured at every scale that a pixel can show, the camera rolled as
/// in a dodge, sensor noise of two gray levels. No two are alike. With raw cameras in `rig` the pairs come
/// raw, else rectified.
std::vector<StereoFrame> stereo_scenes(const CalibratedRig& rig, int count, std::uint64_t seed);

}  // namespace understory
