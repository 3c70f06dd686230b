// What runs on the aircraft, outside the project: samples move the filter, a stereo pair gives hits, and the
// map carries them in the filter's world.  usage: example CALIBRATION LEFT_IMAGE RIGHT_IMAGE
#include <cstdio>
#include <exception>

#include "estimation/filter.hpp"
#include "perception/io/calibration_file.hpp"
#include "perception/io/stereo_recording.hpp"
#include "perception/map/local_map.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"

using namespace understory;

int main(int argc, char** argv) try {
  if (argc != 4) throw std::runtime_error("usage: example CALIBRATION LEFT_IMAGE RIGHT_IMAGE");
  const CalibratedRig rig = read_calibrated_rig(argv[1], {.detection_depth_m = 10});
  if (!rig.calibration) throw std::runtime_error("expected a calibration of raw cameras");
  PushbroomStereo detector(*rig.calibration, rig.rig.detection_depth_m, robust_rule());
  Filter filter((FilterConfig()));
  LocalMap map((LocalMapConfig()));

  for (std::int64_t i = 0; i < 200; ++i)  // a second at rest on the catapult
    filter.on(ImuSample{i * 5'000'000, {0, 0, 0}, {0, 0, 9.81}});

  StereoRecording recording({argv[2], argv[3]});
  for (StereoFrame frame; recording.read(frame);) {
    const State seen = filter.state_at(frame.t_ns);
    map.insert(detector.detect(frame), seen.T_world_body * rig.rig.T_body_camera, frame.t_ns, 0);
  }
  std::printf("looking %.2f m ahead: %zu points\n", detector.detection_depth_m(), map.points().size());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
