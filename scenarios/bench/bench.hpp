#pragma once

#include <functional>
#include <string>
#include <vector>

#include "perception/io/calibration_file.hpp"
#include "perception/stereo_frame.hpp"
#include "scenarios/bench/bench_rows.hpp"

namespace understory {

/// Something to time on the pair of this number.
struct BenchCase {
  std::string name;
  int threads = 1;
  std::string yardstick;  ///< name of the case it is measured against; empty for a yardstick itself
  int every_rounds = 1;   ///< slow ones sit most rounds out
  std::function<void(std::size_t)> run;
};

/// The pairs to time on, as the cameras deliver them and rectified (the same where they come so).
struct BenchPairs {
  std::vector<StereoFrame> delivered, rectified;
};

BenchPairs bench_pairs(const CalibratedRig& rig, const std::vector<StereoFrame>& frames);

/// OpenCV's yardsticks, then the detector's ways; a yardstick stands before what is measured against it.
/// `pairs` must outlive the cases. Sets OpenCV to one thread.
std::vector<BenchCase> bench_cases(const CalibratedRig& rig, const BenchPairs& pairs);

/// Times OpenCV's remap, StereoBM and StereoSGBM and the detector's ways on `frames` (as the rig delivers
/// them: raw where it has raw cameras), all in one run, taking turns round by round, so that what else the
/// machine does falls on all alike. In its turn each goes over all pairs a few times, the first untimed: a
/// pair comes back after all others, from the outer caches. Slow yardsticks sit most of the `rounds` out.
/// OpenCV runs on one thread.
std::vector<BenchRow> bench_detectors(const CalibratedRig& rig, const std::vector<StereoFrame>& frames,
                                      int rounds, const std::function<void(int round)>& on_round);

}  // namespace understory
