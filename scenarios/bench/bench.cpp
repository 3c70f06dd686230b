#include "scenarios/bench/bench.hpp"

#include <chrono>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "perception/full_stereo/full_stereo.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/rectification/rectify.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

/// An algorithm to time: run(i) runs it on pair i.
struct BenchCase {
  std::string name;
  int threads = 1;
  std::string yardstick;  ///< name of the case it is measured against; empty for a yardstick itself
  int every_rounds = 1;   ///< slow ones skip most rounds
  std::function<void(std::size_t)> run;
};

constexpr int passes_in_turn = 10;
constexpr const char* remap_name = "OpenCV remap of the pair, nearest";
constexpr const char* matching_name = "OpenCV StereoBM, 64 disparities, block 9";
constexpr const char* one_depth_name = "detect, 5x5 stride";

/// OpenCV's ways to see, with the images rectified beforehand.
void add_yardsticks(const CalibratedRig& rig, const std::vector<StereoFrame>& raw,
                    const std::vector<StereoFrame>& rectified, std::vector<BenchCase>& cases) {
  if (rig.calibration) {
    const auto map_of = [&](const CameraCalibration& camera) {
      const std::vector<std::int16_t> places = nearest_places(camera, rig.rig.width_px, rig.rig.height_px);
      return cv::Mat(rig.rig.height_px, rig.rig.width_px, CV_16SC2, const_cast<std::int16_t*>(places.data()))
          .clone();
    };
    cases.push_back({remap_name, 1, "", 1,
                     [&raw, left = map_of(rig.calibration->left), right = map_of(rig.calibration->right),
                      out = cv::Mat()](std::size_t i) mutable {
                       cv::remap(raw[i].left, out, left, cv::noArray(), cv::INTER_NEAREST);
                       cv::remap(raw[i].right, out, right, cv::noArray(), cv::INTER_NEAREST);
                     }});
  }
  cases.push_back(
      {matching_name, 1, "", 4,
       [&rectified, matcher = cv::StereoBM::create(64, 9), out = cv::Mat()](std::size_t i) mutable {
         matcher->compute(rectified[i].left, rectified[i].right, out);
       }});
  cases.push_back(
      {"OpenCV StereoSGBM, 64 disparities, block 9", 1, matching_name, 10,
       [&rectified, matcher = cv::StereoSGBM::create(0, 64, 9), out = cv::Mat()](std::size_t i) mutable {
         matcher->compute(rectified[i].left, rectified[i].right, out);
       }});
}

/// Full stereo in the detector's place, as it flies: what perception.compute is fed with.
void add_full_stereo(const CalibratedRig& rig, const std::vector<StereoFrame>& rectified,
                     std::vector<BenchCase>& cases) {
  const auto add = [&](const char* name, FullStereoDetector detector) {
    cases.push_back(
        {name, 1, matching_name, 10, [&rectified, detector = std::move(detector)](std::size_t i) mutable {
           detector.detect(rectified[i]);
         }});
  };
  add("full stereo by StereoBM, 112 disparities", {rig.rig, StereoBmConfig{}, {}});
  add("full stereo by StereoSGBM, 112 disparities", {rig.rig, StereoSgbmConfig{}, {}});
}

/// Depths at and around the rig's own: whole pixels of disparity apart.
std::vector<double> depths_around(const StereoRig& rig, int count) {
  const double px = rig.disparity_px(rig.detection_depth_m);
  std::vector<double> depths_m;
  for (int i = 0; i < count; ++i) depths_m.push_back(rig.depth_m(px + 3 * i));
  return depths_m;
}

void add_detectors(const CalibratedRig& rig, const std::vector<StereoFrame>& raw,
                   const std::vector<StereoFrame>& rectified, std::vector<BenchCase>& cases) {
  const auto detect = [&](const std::string& name, const PushbroomConfig& config,
                          const std::string& yardstick) {
    cases.push_back({name, config.threads, yardstick, 1,
                     [&rectified, detector = PushbroomStereo(rig.rig, config)](std::size_t i) mutable {
                       detector.detect(rectified[i]);
                     }});
  };
  const auto detect_raw = [&](const std::string& name, const PushbroomConfig& config) {
    if (!rig.calibration) return;
    cases.push_back({name, config.threads, remap_name, 1,
                     [&raw, detector = PushbroomStereo(rig, config)](std::size_t i) mutable {
                       detector.detect(raw[i]);
                     }});
  };
  const PushbroomConfig paper = original_pushbroom(), ours = robust_pushbroom();
  PushbroomConfig two_threads = paper, four = paper;
  two_threads.threads = 2;
  four.depths_m = depths_around(rig.rig, 4);
  detect(one_depth_name, paper, matching_name);
  detect("detect, robust parameters", ours, matching_name);
  detect("detect, 4 depths", four, one_depth_name);
  if (rig.calibration)
    cases.push_back(
        {"rectify, nearest", 1, remap_name, 1,
         [&raw, rectifier = std::make_shared<Rectifier>(*rig.calibration, Interpolation::nearest)](
             std::size_t i) { rectifier->rectify(raw[i]); }});
  detect_raw("rectify and detect", paper);
  detect_raw("rectify and detect, two threads", two_threads);
  detect_raw("rectify and detect, robust parameters", ours);
  detect_raw("rectify and detect, parameters for woods", woods_pushbroom("long"));
}

/// The frames themselves where they come rectified.
std::vector<StereoFrame> rectified_pairs(const CalibratedRig& rig, std::vector<StereoFrame> frames) {
  if (!rig.calibration) return frames;
  Rectifier rectifier(*rig.calibration, Interpolation::nearest);
  for (StereoFrame& frame : frames) {
    const StereoFrame turned = rectifier.rectify(frame);
    frame = {frame.t_ns, turned.left.clone(), turned.right.clone()};
  }
  return frames;
}

}  // namespace

std::vector<BenchRow> bench_detectors(const CalibratedRig& rig, const std::vector<StereoFrame>& frames,
                                      int rounds, const std::function<void(int round)>& on_round) {
  const std::vector<StereoFrame> rectified = rectified_pairs(rig, frames);
  cv::setNumThreads(1);
  std::vector<BenchCase> cases;  // a yardstick comes before the cases measured against it
  add_yardsticks(rig, frames, rectified, cases);
  add_full_stereo(rig, rectified, cases);
  add_detectors(rig, frames, rectified, cases);
  std::vector<std::vector<double>> times_ms(cases.size());
  for (int round = 0; round < rounds; ++round) {
    on_round(round);
    for (std::size_t c = 0; c < cases.size(); ++c) {
      if (round % cases[c].every_rounds != 0) continue;
      const int passes = cases[c].every_rounds > 1 ? 1 : passes_in_turn;
      for (std::size_t i = 0; i < frames.size(); ++i)
        cases[c].run(i);  // not timed: what ran before is forgotten
      for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t i = 0; i < frames.size(); ++i) {
          const auto before = std::chrono::steady_clock::now();
          cases[c].run(i);
          times_ms[c].push_back(1e3 * seconds_since(before));
        }
      }
    }
  }
  std::vector<BenchRow> rows;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    BenchRow row{cases[c].name,
                 cases[c].threads,
                 quantile(times_ms[c], 0.5),
                 quantile(times_ms[c], 0.9),
                 quantile(times_ms[c], 0.99),
                 cases[c].yardstick,
                 0};
    for (const BenchRow& other : rows)
      if (other.name == row.yardstick) row.ratio = row.median_ms / other.median_ms;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace understory
