// What runs on the aircraft, outside the project: samples move the filter, a stereo pair gives hits, and the
// map carries them in the filter's world.  usage: example CALIBRATION RECORDING...
// CALIBRATION: as read_calibrated_rig takes it. RECORDING: as StereoRecording takes it: a EuRoC folder, for
// instance what `understory record` writes (its own calibration too), two images, two folders or a video.
#include <cstdio>
#include <exception>

#include "estimation/filter.hpp"
#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/stereo_recording.hpp"
#include "perception/map/local_map.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"

using namespace understory;

int main(int argc, char** argv) try {
  if (argc < 3) throw std::runtime_error("usage: example CALIBRATION RECORDING...");
  const CalibratedRig rig = read_calibrated_rig(argv[1], {.detection_depth_m = 10});
  PushbroomStereo detector(rig, robust_pushbroom());
  Filter filter((FilterConfig()));
  LocalMap map((LocalMapConfig()));

  for (std::int64_t i = 0; i < 200; ++i)  // a second at rest on the catapult
    filter.on(ImuSample{i * 5'000'000, {0, 0, 0}, {0, 0, 9.81}});

  StereoRecording recording({argv + 2, argv + argc});
  std::size_t hits = 0;
  for (StereoFrame frame; recording.read(frame);) {
    const State seen = filter.state_at(frame.t_ns);
    const std::vector<StereoHit>& found = detector.detect(frame);
    map.insert(found, seen.T_world_body * rig.rig.T_body_camera, frame.t_ns, 0);
    hits += found.size();
  }
  std::printf("looking %.2f m ahead: %zu hits, %zu points\n", detector.detection_depth_m(), hits,
              map.points().size());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
