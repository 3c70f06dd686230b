#include "scenarios/detect/detection_run.hpp"

#include "scenarios/detect/recorded_detector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/hit_files.hpp"
#include "perception/io/image_sequence.hpp"
#include "perception/io/pose_file.hpp"
#include "perception/io/stereo_recording.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/detect/posed_map.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/report/pictures.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// The rig the options name, or the EuRoC input's own; its size is that of the images.
CalibratedRig rig_for(const DetectionOptions& options, const StereoRecording& recording) {
  const bool brings_its_own = options.inputs.size() == 1 && euroc_folder(options.inputs[0]).has_value();
  if (options.rig.empty() && !brings_its_own)
    throw ScenarioError(fmt::format("{}: requires --rig: only EuRoC folders bring their calibration",
                                    options.inputs.front().string()));
  const fs::path file = options.rig.empty() ? options.inputs[0] : options.rig;
  const cv::Size images = recording.image_size();
  CalibrationOptions calibration = options.calibration;
  calibration.images_at_hand = images;
  const CalibratedRig camera = bad_input_if_refused([&] { return read_calibrated_rig(file, calibration); });
  if (images != cv::Size(camera.rig.width_px, camera.rig.height_px))
    throw ScenarioError(fmt::format("{}: must be {}x{} as {} says, is {}x{}", recording.first_file().string(),
                                    camera.rig.width_px, camera.rig.height_px, file.string(), images.width,
                                    images.height));
  return camera;
}

/// The rule's numbers for the rig given, or for the one that flew, where the recording tells it.
VisionConfig vision_for(const DetectionOptions& options, const StereoRig& rig) {
  std::string name = options.rig.empty() ? rig_named_in(options.inputs[0]) : "";
  if (name.empty()) name = rig.name;
  VisionConfigSources sources = options.vision;
  sources.one_depth = options.calibration.detection_depth_m.has_value();  // --depth goes before the preset's
  const VisionConfig config = read_vision_config(sources, name);
  check_depths(config.pushbroom(), rig, "perception.depths_m", "perception.pushbroom");
  return config;
}

/// Of the body; none where the options name no file.
std::vector<TimedPose> poses_for(const DetectionOptions& options, const StereoRecording& recording) {
  if (options.poses.empty()) return {};
  auto poses = bad_input_if_refused([&] { return read_poses(options.poses); });
  const auto images = recording.times();
  if (!images)
    throw ScenarioError(fmt::format("--poses requires images with times: their names hold none ({})",
                                    recording.first_file().string()));
  const auto seconds = [](std::int64_t t_ns) { return 1e-9 * static_cast<double>(t_ns); };
  const std::int64_t first_ns = poses.front().t_ns, last_ns = poses.back().t_ns;
  if (images->last_ns < first_ns || images->first_ns > last_ns)
    throw ScenarioError(fmt::format(
        "{}: the poses must cover the images' time, {:.3f} to {:.3f} s, they cover {:.3f} to {:.3f} s",
        options.poses.string(), seconds(images->first_ns), seconds(images->last_ns), seconds(first_ns),
        seconds(last_ns)));
  return poses;
}

/// Pictures a second of a film of the recording: its own pace, within what players take.
double film_rate_hz(const StereoRecording& recording) {
  constexpr double where_unknown_hz = 20, minimum_hz = 1, maximum_hz = 120;
  const auto times = recording.times();
  const std::int64_t count = recording.frame_count();
  if (!times || count < 2) return where_unknown_hz;
  const double span_s = 1e-9 * static_cast<double>(times->last_ns - times->first_ns);
  return std::clamp(static_cast<double>(count - 1) / span_s, minimum_hz, maximum_hz);
}

/// Runs `work` and sets its wall time; gives back what `work` gives.
template <typename Work>
decltype(auto) timed(double& taken_ms, Work&& work) {
  const Clock::time_point begin = Clock::now();
  decltype(auto) made = work();
  taken_ms = 1e3 * seconds_since(begin);
  return made;
}

/// Every point that ever came into the map, as when it was first seen, and the map itself.
struct CarriedMap {
  std::vector<TimedPose> poses;
  PosedMap map;
  std::vector<ObstaclePoint> remembered = {};

  /// Where the camera was; nothing, and nothing is done, where the poses do not cover that moment.
  std::optional<Eigen::Isometry3d> insert(const FrameHits& seen, const StereoRig& rig) {
    const auto T_world_body = pose_at(poses, seen.t_ns);
    if (!T_world_body) return {};
    const Eigen::Isometry3d T_world_camera = *T_world_body * rig.T_body_camera;
    map.insert(seen.hits, T_world_camera, seen.t_ns);
    std::ranges::copy_if(map.points(), std::back_inserter(remembered), [&](const ObstaclePoint& point) {
      return point.t_ns == seen.t_ns && point.sightings == 1;
    });
    return T_world_camera;
  }
};

/// What a person looks at afterwards: the overlay of every frame, as overlays/000000.png ... or as
/// overlay.mp4.
class DetectionPictures {
 public:
  DetectionPictures(const DetectionOptions& options, const StereoRecording& recording, const fs::path& folder)
      : folder_(folder / "overlays") {
    if (options.video)
      film_ = std::make_unique<VideoFile>(folder / "overlay.mp4", film_rate_hz(recording));
    else
      prepare_output_folder(folder_);
  }
  void add(const OverlayMoment& moment, const StereoRig& rig) {
    constexpr int narrow_px = 500;  // images below this are drawn at twice their size
    const cv::Mat picture = draw_overlay(moment, rig, rig.width_px < narrow_px ? 2 : 1);
    if (film_)  // H.264 wants even sides: the last column or row goes
      film_->add(picture(cv::Rect(0, 0, picture.cols / 2 * 2, picture.rows / 2 * 2)));
    else
      write_picture(folder_ / fmt::format("{:06}.png", count_++), picture);
  }
  void finish() {
    if (film_) film_->finish();
  }

 private:
  fs::path folder_;
  std::int64_t count_ = 0;
  std::unique_ptr<VideoFile> film_;
};

std::string timings_csv(const std::vector<FrameRecord>& frames) {
  Table table{{"frame", "t_ns", "hits", "rectify_ms", "detect_ms", "in_map"}};
  for (const FrameRecord& frame : frames)
    table.add(table.rows.size(), frame.t_ns, frame.hits, number_text(frame.rectify_ms, 4),
              number_text(frame.detect_ms, 4), frame.in_map ? 1 : 0);
  return to_csv(table);
}

/// What is known before the first frame.
DetectionResult described(const CalibratedRig& camera, const ObstacleDetector& detector,
                          const VisionConfig& config, const StereoRecording& recording) {
  DetectionResult result;
  result.rig = camera.rig;
  result.detector = config.detector;
  result.rectified_here = camera.calibration.has_value();
  if (const auto* pushbroom = dynamic_cast<const PushbroomStereo*>(&detector))
    for (int i = 0; i < pushbroom->depth_count(); ++i)
      result.depths.push_back({pushbroom->detection_depth_m(i), pushbroom->detection_disparity_px(i),
                               pushbroom->one_pixel_interval(i)});
  result.last_row_px = camera.rig.scaled_row_px(config.pushbroom().last_row_px);
  result.frames_expected = recording.frame_count();
  result.unpaired_images = recording.unpaired();
  return result;
}

/// "detections at 10.14 m", "detections of edges".
std::string depths_text(const DetectionResult& result) {
  if (result.depths.empty()) return "of " + result.detector;
  std::vector<std::string> texts;
  for (const auto& depth : result.depths) texts.push_back(fmt::format("{:.2f}", depth.depth_m));
  return fmt::format("at {} m", fmt::join(texts, ", "));
}

}  // namespace

DetectionResult run_detection(const DetectionOptions& options) {
  StereoRecording recording = bad_input_if_refused([&] { return StereoRecording(options.inputs); });
  const CalibratedRig camera = rig_for(options, recording);
  const VisionConfig config = vision_for(options, camera.rig);
  CarriedMap map{poses_for(options, recording), PosedMap(config.map)};
  std::optional<Rectifier> rectifier;
  if (camera.calibration) rectifier.emplace(*camera.calibration, options.interpolation);
  RecordedDetector recorded(config, config.detector, camera.rig);
  ObstacleDetector& detector = recorded.detector();
  std::vector<fs::path> read = options.inputs;
  read.push_back(options.rig);
  require_separate({options.output_folder}, read);
  OutputFolder output(options.output_folder, detection_results, "", Replace::anything);
  DetectionResult result = described(camera, detector, config, recording);
  const std::string depths = depths_text(result);
  DetectionPictures pictures(options, recording, output.path());
  std::vector<FrameHits> hits;
  std::int64_t hit_count = 0;
  StereoFrame frame;
  while (bad_input_if_refused([&] { return recording.read(frame); })) {
    FrameRecord& record = result.frames.emplace_back();
    record.t_ns = frame.t_ns;
    const StereoFrame rectified =
        rectifier ? timed(record.rectify_ms, [&] { return rectifier->rectify(frame); }) : frame;
    FrameHits& seen = hits.emplace_back();
    seen = {std::ssize(hits) - 1, frame.t_ns,
            timed(record.detect_ms, [&]() -> decltype(auto) { return detector.detect(rectified); })};
    record.hits = std::ssize(seen.hits);
    OverlayMoment moment;
    moment.left = rectified.left;
    moment.hits = seen.hits;
    moment.caption = fmt::format("frame {}: {} detections {}", seen.frame, record.hits, depths);
    if (const auto T_world_camera = map.insert(seen, camera.rig)) {
      record.in_map = true;
      moment.remembered = map.map.points();
      moment.T_world_camera = *T_world_camera;
    }
    pictures.add(moment, camera.rig);
    hit_count += record.hits;
    if (options.on_progress)
      options.on_progress(std::ssize(result.frames), result.frames_expected, hit_count);
  }
  pictures.finish();
  const bool has_map = !options.poses.empty();
  if (has_map) result.remembered_points = std::ssize(map.remembered);
  const fs::path& folder = output.path();
  write_whole_file(folder / "timings.csv", timings_csv(result.frames));
  if (has_map) write_whole_file(folder / "map.ply", points_to_ply(map.remembered));
  write_whole_file(folder / "points.ply", hits_to_ply(hits));
  write_whole_file(folder / "points.csv", hits_to_csv(hits));
  output.finish();
  result.files = fmt::format("{}: points.csv, points.ply, timings.csv, {}{}", options.output_folder.string(),
                             has_map ? "map.ply, " : "", options.video ? "overlay.mp4" : "overlays/");
  return result;
}

}  // namespace understory
