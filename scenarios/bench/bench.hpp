#pragma once

#include <functional>
#include <string>
#include <vector>

#include "perception/io/calibration_file.hpp"
#include "perception/stereo_frame.hpp"

namespace understory {

/// What one thing costs for one pair, over all pairs and rounds.
struct BenchRow {
  std::string name;
  int threads = 1;
  double median_ms = 0;
  double p90_ms = 0;
  double p99_ms = 0;
  std::string yardstick;  ///< name of the row it is measured against; empty for a yardstick itself
  double ratio = 0;       ///< median over the yardstick's; 0 for a yardstick
};

struct BenchOptions {
  int rounds = 20;  ///< over all pairs; slow yardsticks fewer
  std::function<void(int round, int rounds)> on_progress = [](int, int) {};
};

/// Times OpenCV's remap, StereoBM and StereoSGBM and the detector's ways on `frames` (as the rig delivers
/// them: raw where it has raw cameras), all in one run, taking turns round by round, so that what else the
/// machine does falls on all alike. In its turn each goes over all pairs a few times, the first untimed: a
/// pair comes back after all others, from the outer caches. OpenCV runs on one thread.
std::vector<BenchRow> bench_detectors(const CalibratedRig& rig, const std::vector<StereoFrame>& frames,
                                      const BenchOptions& options);

/// A table for a person, and the same as a JSON list of rows.
std::string to_table(const std::vector<BenchRow>& rows);
std::string to_json(const std::vector<BenchRow>& rows);

}  // namespace understory
