#include <fmt/format.h>

#include <algorithm>

#include "scenarios/detect/detection_run.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

std::string row(const char* name, const std::string& text) { return fmt::format("  {:<18}{}\n", name, text); }

std::string times_text(const std::vector<FrameRecord>& frames, double FrameRecord::*stage) {
  std::vector<double> times_ms;
  for (const FrameRecord& frame : frames) times_ms.push_back(frame.*stage);
  return fmt::format("median {:.3f} ms, p99 {:.3f} ms", quantile(times_ms, 0.5), quantile(times_ms, 0.99));
}

std::string hits_text(const std::vector<FrameRecord>& frames) {
  std::int64_t hits = 0, frames_with_hits = 0;
  for (const FrameRecord& frame : frames) {
    hits += frame.hits;
    frames_with_hits += frame.hits > 0 ? 1 : 0;
  }
  const double per_frame =
      frames.empty() ? 0 : static_cast<double>(hits) / static_cast<double>(frames.size());
  return fmt::format("{}, {:.1f} per frame, in {} frames", hits, per_frame, frames_with_hits);
}

std::string frames_text(const DetectionResult& result) {
  const auto count = static_cast<std::int64_t>(result.frames.size());
  std::string text = fmt::format("{} of {}x{} px, {}", count, result.rig.width_px, result.rig.height_px,
                                 result.rectified_here ? "rectified here" : "taken as rectified");
  if (count != result.frames_expected) text += fmt::format("; the video claims {}", result.frames_expected);
  if (result.unpaired_images > 0)
    text += fmt::format("; images without partner, left out: {}", result.unpaired_images);
  return text;
}

std::string map_text(const DetectionResult& result) {
  std::string text = fmt::format("{} points", *result.remembered_points);
  const auto outside = std::count_if(result.frames.begin(), result.frames.end(),
                                     [](const FrameRecord& f) { return !f.in_map; });
  if (outside > 0) text += fmt::format("; frames outside the poses' time, left out: {}", outside);
  return text;
}

}  // namespace

std::string to_report(const DetectionResult& result) {
  const StereoRig& rig = result.rig;
  std::string text = row("frames", frames_text(result));
  text += row("rig", fmt::format("{}: focal length {:.1f} px, baseline {:.3f} m", rig.name, rig.focal_px,
                                 rig.baseline_m));
  if (result.depths.empty()) text += row("detector", result.detector);
  for (const DetectionResult::Depth& depth : result.depths)
    text +=
        row("looked at", fmt::format("{:.2f} m ({} px; a pixel either way {:.2f} to {:.2f} m), rows 0 to {}",
                                     depth.depth_m, depth.disparity_px, depth.one_pixel.near_m,
                                     depth.one_pixel.far_m, result.last_row_px));
  text += row("detections", hits_text(result.frames));
  if (result.rectified_here) text += row("rectify", times_text(result.frames, &FrameRecord::rectify_ms));
  text += row("detect", times_text(result.frames, &FrameRecord::detect_ms));
  if (result.remembered_points) text += row("map", map_text(result));
  text += row("files", result.files);
  return text;
}

}  // namespace understory
