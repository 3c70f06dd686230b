#include "scenarios/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "perception/pushbroom_stereo.hpp"
#include "perception/rectify.hpp"

namespace understory {
namespace {

using Clock = std::chrono::steady_clock;

/// Something to time on the pair of this number.
struct Bench {
  std::string name;
  int threads = 1;
  std::string yardstick;
  int every_rounds = 1;  // slow ones sit most rounds out
  std::function<void(std::size_t)> run;
  std::vector<double> times_ms;
};

constexpr int passes_in_turn = 10;

constexpr const char* remap_name = "OpenCV remap of the pair, nearest";
constexpr const char* matching_name = "OpenCV StereoBM, 64 disparities, block 9";
constexpr const char* one_depth_name = "detect, 5x5 stride";

/// OpenCV's ways to see, with the images rectified beforehand.
void add_yardsticks(const CalibratedRig& rig, const std::vector<StereoFrame>& raw,
                    const std::vector<StereoFrame>& rectified, std::deque<Bench>& benches) {
  if (rig.calibration) {
    const auto map_of = [&](const CameraCalibration& camera) {
      const std::vector<std::int16_t> places = nearest_places(camera, rig.rig.width_px, rig.rig.height_px);
      return cv::Mat(rig.rig.height_px, rig.rig.width_px, CV_16SC2, const_cast<std::int16_t*>(places.data()))
          .clone();
    };
    benches.push_back({remap_name,
                       1,
                       "",
                       1,
                       [&raw, left = map_of(rig.calibration->left), right = map_of(rig.calibration->right),
                        out = cv::Mat()](std::size_t i) mutable {
                         cv::remap(raw[i].left, out, left, cv::noArray(), cv::INTER_NEAREST);
                         cv::remap(raw[i].right, out, right, cv::noArray(), cv::INTER_NEAREST);
                       },
                       {}});
  }
  benches.push_back(
      {matching_name,
       1,
       "",
       4,
       [&rectified, matcher = cv::StereoBM::create(64, 9), out = cv::Mat()](std::size_t i) mutable {
         matcher->compute(rectified[i].left, rectified[i].right, out);
       },
       {}});
  benches.push_back(
      {"OpenCV StereoSGBM, 64 disparities, block 9",
       1,
       matching_name,
       10,
       [&rectified, matcher = cv::StereoSGBM::create(0, 64, 9), out = cv::Mat()](std::size_t i) mutable {
         matcher->compute(rectified[i].left, rectified[i].right, out);
       },
       {}});
}

/// Depths at and around the rig's own: whole pixels of disparity apart.
std::vector<double> depths_around(const StereoRig& rig, int count) {
  const double px = rig.disparity_px(rig.detection_depth_m);
  std::vector<double> depths_m;
  for (int i = 0; i < count; ++i) depths_m.push_back(rig.depth_m(px + 3 * i));
  return depths_m;
}

void add_detectors(const CalibratedRig& rig, const std::vector<StereoFrame>& raw,
                   const std::vector<StereoFrame>& rectified, std::deque<Bench>& benches) {
  const auto detect = [&](const std::string& name, const PushbroomConfig& config,
                          const std::string& yardstick) {
    benches.push_back({name,
                       config.threads,
                       yardstick,
                       1,
                       [&rectified, detector = PushbroomStereo(rig.rig, config)](std::size_t i) mutable {
                         detector.detect(rectified[i]);
                       },
                       {}});
  };
  const auto detect_raw = [&](const std::string& name, const PushbroomConfig& config) {
    if (!rig.calibration) return;
    benches.push_back(
        {name,
         config.threads,
         remap_name,
         1,
         [&raw, detector = PushbroomStereo(*rig.calibration, rig.rig.detection_depth_m, config)](
             std::size_t i) mutable { detector.detect(raw[i]); },
         {}});
  };
  PushbroomConfig paper = paper_rule(), ours = robust_rule();
  paper.last_row_px = ours.last_row_px = last_row_px_of(rig.rig.height_px);
  PushbroomConfig two_threads = paper, dense = paper, four = paper;
  two_threads.threads = 2;
  dense.every_pixel = true;
  four.depths_m = depths_around(rig.rig, 4);
  detect(one_depth_name, paper, matching_name);
  detect("detect, our rule", ours, matching_name);
  detect("detect, 4 depths", four, one_depth_name);
  if (rig.calibration)
    benches.push_back(
        {"rectify, nearest",
         1,
         remap_name,
         1,
         [&raw, rectifier = std::make_shared<Rectifier>(*rig.calibration, Interpolation::nearest)](
             std::size_t i) { rectifier->rectify(raw[i]); },
         {}});
  detect_raw("rectify and detect", paper);
  detect_raw("rectify and detect, two threads", two_threads);
  detect_raw("rectify and detect, every pixel", dense);
  detect_raw("rectify and detect, our rule", ours);
}

double percentile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::vector<BenchRow> bench_detectors(const CalibratedRig& rig, const std::vector<StereoFrame>& frames,
                                      const BenchOptions& options) {
  cv::setNumThreads(1);
  std::vector<StereoFrame> rectified = frames;
  if (rig.calibration) {
    Rectifier rectifier(*rig.calibration, Interpolation::nearest);
    for (StereoFrame& frame : rectified) {
      const StereoFrame turned = rectifier.rectify(frame);
      frame = {frame.t_ns, turned.left.clone(), turned.right.clone()};
    }
  }
  std::deque<Bench> benches;
  add_yardsticks(rig, frames, rectified, benches);
  add_detectors(rig, frames, rectified, benches);
  for (int round = 0; round < options.rounds; ++round) {
    options.on_progress(round, options.rounds);
    for (Bench& bench : benches) {
      if (round % bench.every_rounds != 0) continue;
      const int passes = bench.every_rounds > 1 ? 1 : passes_in_turn;
      for (std::size_t i = 0; i < frames.size(); ++i)
        bench.run(i);  // not timed: what ran before is forgotten
      for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t i = 0; i < frames.size(); ++i) {
          const auto before = Clock::now();
          bench.run(i);
          bench.times_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - before).count());
        }
      }
    }
  }
  std::vector<BenchRow> rows;
  for (const Bench& bench : benches) {
    BenchRow row{bench.name,
                 bench.threads,
                 percentile(bench.times_ms, 0.5),
                 percentile(bench.times_ms, 0.9),
                 percentile(bench.times_ms, 0.99),
                 bench.yardstick,
                 0};
    for (const BenchRow& other : rows)
      if (other.name == row.yardstick) row.ratio = row.median_ms / other.median_ms;
    rows.push_back(row);
  }
  return rows;
}

std::string to_table(const std::vector<BenchRow>& rows) {
  std::string text =
      fmt::format("{:<44}{:>8}{:>11}{:>9}{:>9}  {}\n", "", "threads", "median ms", "p90", "p99", "against");
  for (const BenchRow& row : rows) {
    text += fmt::format("{:<44}{:>8}{:>11.4f}{:>9.4f}{:>9.4f}", row.name, row.threads, row.median_ms,
                        row.p90_ms, row.p99_ms);
    if (row.ratio > 0 && row.ratio < 0.05)
      text += fmt::format("  {:.0f} times faster than {}", 1 / row.ratio, row.yardstick);
    else if (row.ratio > 0)
      text += fmt::format("  {:.2f} of {}", row.ratio, row.yardstick);
    text += "\n";
  }
  return text;
}

std::string to_json(const std::vector<BenchRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const BenchRow& row : rows) {
    nlohmann::ordered_json one{{"name", row.name},     {"threads", row.threads}, {"median_ms", row.median_ms},
                               {"p90_ms", row.p90_ms}, {"p99_ms", row.p99_ms},   {"yardstick", nullptr},
                               {"ratio", nullptr}};
    if (row.ratio > 0) one["yardstick"] = row.yardstick, one["ratio"] = row.ratio;
    list.push_back(one);
  }
  return list.dump(2) + "\n";
}

}  // namespace understory
