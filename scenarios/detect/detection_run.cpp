#include "scenarios/detect/detection_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <iterator>
#include <optional>

#include "perception/io/hit_files.hpp"
#include "perception/io/stereo_recording.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/detect/detection_input.hpp"
#include "scenarios/detect/detection_pictures.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/report/picture_folder.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Runs `work` and adds its wall time to `sum_ms`; gives back what `work` gives.
template <typename Work>
decltype(auto) timed(double& sum_ms, Work&& work) {
  const Clock::time_point begin = Clock::now();
  decltype(auto) made = work();
  sum_ms += 1e3 * seconds_since(begin);
  return made;
}

void write_results(const fs::path& folder, const DetectionResult& result, const std::vector<FrameHits>& hits,
                   const std::optional<PosedMap>& map) {
  write_whole_file(folder / "timings.csv", frames_to_csv(result.frames));
  if (map) write_whole_file(folder / "map.ply", points_to_ply(map->remembered()));
  write_whole_file(folder / "points.ply", hits_to_ply(hits));
  write_whole_file(folder / "points.csv", hits_to_csv(hits));
}

/// What is known before the first frame.
DetectionResult described(const CalibratedRig& camera, const PushbroomStereo& detector,
                          const DetectionConfig& config, const StereoRecording& recording) {
  DetectionResult result;
  result.rig = camera.rig;
  result.rectified_here = camera.calibration.has_value();
  for (int i = 0; i < detector.depth_count(); ++i)
    result.depths.push_back(
        {detector.detection_depth_m(i), detector.detection_disparity_px(i), detector.one_pixel_interval(i)});
  result.last_row_px = config.pushbroom.last_row_px;
  result.frames_expected = recording.frame_count();
  result.unpaired_images = recording.unpaired();
  return result;
}

std::string depths_text(const DetectionResult& result) {
  std::vector<std::string> texts;
  for (const auto& depth : result.depths) texts.push_back(fmt::format("{:.2f}", depth.depth_m));
  return fmt::format("{} m", fmt::join(texts, ", "));
}

/// What an earlier run left must not pass for this one's.
void prepare(const fs::path& folder) {
  prepare_output_folder(folder);
  remove_pictures(folder / "overlays");
  std::error_code shows_when_written;
  for (const char* file : {"points.csv", "points.ply", "timings.csv", "map.ply", "overlay.mp4"})
    fs::remove(folder / file, shows_when_written);
}

}  // namespace

DetectionResult run_detection(const DetectionOptions& options) {
  const Clock::time_point begin = Clock::now();
  StereoRecording recording = bad_input_if_refused([&] { return StereoRecording(options.inputs); });
  const CalibratedRig camera = rig_for(options, recording);
  const DetectionConfig config = config_for(options, camera.rig);
  std::optional<PosedMap> map = map_for(options, recording, camera.rig, config.map);
  std::optional<Rectifier> rectifier;
  if (camera.calibration) rectifier.emplace(*camera.calibration, options.interpolation);
  PushbroomStereo detector(camera.rig, config.pushbroom);
  prepare(options.output_folder);
  DetectionResult result = described(camera, detector, config, recording);
  DetectionPictures pictures(options.output_folder, camera.rig, depths_text(result),
                             options.video ? film_rate_hz(recording) : 0);
  std::vector<FrameHits> hits;
  std::int64_t hit_count = 0;
  StereoFrame frame;
  while (bad_input_if_refused([&] { return recording.read(frame); })) {
    FrameRecord record;
    record.t_ns = frame.t_ns;
    const StereoFrame rectified =
        rectifier ? timed(record.rectify_ms, [&] { return rectifier->rectify(frame); }) : frame;
    FrameHits& seen = hits.emplace_back();
    seen = {std::ssize(result.frames), frame.t_ns,
            timed(record.detect_ms, [&]() -> decltype(auto) { return detector.detect(rectified); })};
    record.hits = std::ssize(seen.hits);
    record.in_map = map && map->insert(seen.hits, frame.t_ns);
    pictures.add(rectified.left, seen.hits, record.in_map ? &*map : nullptr);
    result.frames.push_back(record);
    hit_count += record.hits;
    if (options.on_progress)
      options.on_progress(
          {std::ssize(result.frames), result.frames_expected, hit_count, seconds_since(begin)});
  }
  pictures.finish();
  if (map) result.remembered_points = std::ssize(map->remembered());
  write_results(options.output_folder, result, hits, map);
  result.files = fmt::format("{}: points.csv, points.ply, timings.csv, {}{}", options.output_folder.string(),
                             map ? "map.ply, " : "", options.video ? "overlay.mp4" : "overlays/");
  return result;
}

}  // namespace understory
