#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/hit_files.hpp"
#include "perception/io/pose_file.hpp"
#include "perception/io/stereo_recording.hpp"
#include "perception/io/text_table.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/recording/euroc_recording.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "tests/scenarios/recordings.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// A recording read back by those who read strangers' data sets, against what the flight itself saw.
namespace understory {
namespace {

namespace fs = std::filesystem;
using support::content_of;
using support::TemporaryFolder;

Scenario scenario_with(const std::string& name, std::vector<std::string> settings) {
  settings.push_back("seed=1007");
  settings.push_back("cameras.rate_hz=60");
  return library_scenario(name, settings);
}

/// Launch and some metres towards a dense stand of trees.
Scenario short_flight(const std::vector<std::string>& more = {}) {
  std::vector<std::string> settings{"forest.clear_m=11", "forest.square_metres_per_tree=8",
                                    "time_limit_s=1.1"};
  settings.insert(settings.end(), more.begin(), more.end());
  return scenario_with("forest", settings);
}

/// What a flight saw, and its recording under <folder>/recorded.
struct Flown : FlightObserver {
  void on_frame(const Flight& flight) override {
    frames.push_back({flight.frame().t_ns, flight.frame().left.clone(), flight.frame().right.clone()});
  }
  void on_step(const Flight& flight) override {
    truths.push_back(flight.truth());
    if (!flight.clock().imu()) return;
    samples.push_back(flight.newest<ImuSample>().value());
    estimates.push_back(flight.state());
  }

  CalibratedRig rig;
  std::vector<Obstacle> trunks;
  std::vector<StereoFrame> frames;
  std::vector<Truth> truths;
  std::vector<ImuSample> samples;
  std::vector<State> estimates;
  FlightResult result;
};

Flown flown(const Scenario& scenario, const fs::path& folder) {
  Flown flight;
  FlyOptions options = into({});
  flight.rig = rig_of(scenario, options.models_folder);
  flight.trunks = course_obstacles(scenario);
  EurocRecording recording(folder, scenario, flight.rig, 2);
  options.observers = {&recording, &flight};
  flight.result = fly(scenario, options);
  recording.finish();
  return flight;
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

void expect_alike(const StereoRig& read, const StereoRig& rig) {
  EXPECT_EQ(read.width_px, rig.width_px);
  EXPECT_EQ(read.height_px, rig.height_px);
  EXPECT_NEAR(read.focal_px, rig.focal_px, 1e-9);
  EXPECT_NEAR(read.baseline_m, rig.baseline_m, 1e-12);
  EXPECT_NEAR(read.center_left_x_px, rig.center_left_x_px, 1e-9);
  EXPECT_NEAR(read.center_right_x_px, rig.center_right_x_px, 1e-9);
  EXPECT_NEAR(read.center_y_px, rig.center_y_px, 1e-9);
  EXPECT_EQ(read.detection_depth_m, rig.detection_depth_m);
  EXPECT_TRUE(read.T_body_camera.isApprox(rig.T_body_camera, 1e-9));
}

/// Of a map's points, those within the detector's depth interval of a trunk: the poses, the cameras' places
/// and the axes must all be right for that.
double share_on_trunks(std::string map, const std::vector<Obstacle>& trunks) {
  map.erase(0, map.find("end_header") + 10);
  int on_trunks = 0, count = 0;
  const auto lines = table_lines(map, CellsParted::by_blanks, "");
  for (const TableLine& line : lines) {
    const Eigen::Vector3d point(*number_in(line.cells[0]), *number_in(line.cells[1]),
                                *number_in(line.cells[2]));
    const auto holds = [&](const Obstacle& trunk) {
      return segment_distance_m({point, point}, {trunk.from_world, trunk.to_world}) < trunk.radius_m + 0.8;
    };
    on_trunks += std::any_of(trunks.begin(), trunks.end(), holds) ? 1 : 0;
    ++count;
  }
  return count > 0 ? static_cast<double>(on_trunks) / count : 0;
}

/// Detection on the folder, no option but the poses, finds what the detector finds in the flight's frames.
void expect_same_hits(const Flown& flight, const fs::path& recorded, const fs::path& out) {
  const auto outcome = support::understory("detect " + recorded.string() + " --poses " +
                                           (recorded / "mav0/state_groundtruth_estimate0/data.csv").string() +
                                           " --out " + out.string());
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  PushbroomStereo detector(flight.rig, robust_pushbroom());
  std::vector<FrameHits> expected;
  std::size_t hits = 0;
  for (const StereoFrame& frame : flight.frames) {
    const auto count = static_cast<std::int64_t>(expected.size());
    expected.push_back({count, recorded_ns(frame.t_ns), detector.detect(frame)});
    hits += expected.back().hits.size();
  }
  EXPECT_GT(hits, 20u);
  EXPECT_EQ(content_of(out / "points.csv"), hits_to_csv(expected));
  EXPECT_GT(share_on_trunks(content_of(out / "map.ply"), flight.trunks), 0.8);
}

TEST(EurocRecording, AFlightReadsBackAsItWas) {
  const TemporaryFolder folder;
  const Flown flight = flown(short_flight(), folder.path());
  ASSERT_GT(flight.frames.size(), 50u);

  const CalibratedRig calibrated = read_calibrated_rig(folder.path(), {});
  expect_alike(calibrated.rig, flight.rig.rig);
  EXPECT_FALSE(calibrated.calibration.has_value());  // the images come rectified
  StereoRecording read({folder.path()});
  ASSERT_EQ(read.frame_count(), static_cast<std::int64_t>(flight.frames.size()));
  for (const StereoFrame& frame : flight.frames) {
    StereoFrame found;
    ASSERT_TRUE(read.read(found));
    EXPECT_EQ(found.t_ns, recorded_ns(frame.t_ns));
    EXPECT_TRUE(same_bytes(found.left, frame.left) && same_bytes(found.right, frame.right)) << frame.t_ns;
  }
  const auto poses = read_poses(folder.path() / "mav0/state_groundtruth_estimate0/data.csv");
  for (const StereoFrame& frame : flight.frames)
    for (const Truth& truth : flight.truths) {
      if (truth.t_ns != frame.t_ns) continue;
      const auto pose = pose_at(poses, recorded_ns(frame.t_ns));
      ASSERT_TRUE(pose.has_value());
      EXPECT_LT((pose->translation() - truth.T_world_body.translation()).norm(), 1e-6);
      EXPECT_LT(apart_rad(*pose, truth.T_world_body), 1e-6);
    }
  const auto estimates = read_poses(folder.path() / "mav0/estimate0/data.csv");
  for (const State& state : flight.estimates) {
    const auto pose = pose_at(estimates, recorded_ns(state.t_ns));
    ASSERT_TRUE(pose.has_value());
    EXPECT_LT((pose->translation() - state.T_world_body.translation()).norm(), 1e-6);
  }
  expect_same_hits(flight, folder.path(), folder.path() / "found");
}

TEST(EurocRecording, TheImuTableHoldsItsSamples) {
  const TemporaryFolder folder;
  const Flown flight = flown(short_flight({"perception.detector=none"}), folder.path());
  ASSERT_FALSE(flight.frames.empty());  // rendered although nobody on board looks
  const std::string text = content_of(folder.path() / "mav0/imu0/data.csv");
  const auto lines = table_lines(text, CellsParted::by_commas, "");
  ASSERT_EQ(lines.size(), flight.samples.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    ASSERT_EQ(lines[i].cells.size(), 7u);
    EXPECT_EQ(nanoseconds_in(lines[i].cells[0]), recorded_ns(flight.samples[i].t_ns));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(*number_in(lines[i].cells[1 + axis]), flight.samples[i].angular_rate_body_radps[axis],
                  1e-8);
      EXPECT_NEAR(*number_in(lines[i].cells[4 + axis]), flight.samples[i].specific_force_body_mps2[axis],
                  1e-8);
    }
  }
}

/// At rest on the rail the IMU says gravity and its biases: what the ground truth says they are.
TEST(EurocRecording, TheBiasesAreTheFlightsOwn) {
  const TemporaryFolder folder;
  const Scenario scenario = short_flight({"sensors.imu.gyro_bias_radps=0.2", "sensors.imu.gyro_noise_radps=0",
                                          "sensors.imu.accelerometer_bias_mps2=2",
                                          "sensors.imu.accelerometer_noise_mps2=0", "time_limit_s=0.3"});
  const Flown flight = flown(scenario, folder.path());
  const std::string text = content_of(folder.path() / "mav0/state_groundtruth_estimate0/data.csv");
  const auto line = table_lines(text, CellsParted::by_commas, "").front();
  ASSERT_EQ(line.cells.size(), 17u);
  const Eigen::Vector3d gravity_body =
      flight.truths[0].T_world_body.linear().transpose() * Eigen::Vector3d(0, 0, 9.81);
  const ImuConfig& config = scenario.sensors.imu;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(*number_in(line.cells[11 + axis]), flight.samples[5].angular_rate_body_radps[axis],
                config.gyro_step_radps);
    EXPECT_NEAR(*number_in(line.cells[14 + axis]),
                flight.samples[5].specific_force_body_mps2[axis] - gravity_body[axis], 0.01);
  }
}

TEST(EurocRecording, RawImagesGiveTheFlightsHitsToo) {
  const TemporaryFolder folder;
  const Flown flight = flown(short_flight({"cameras.raw=true"}), folder.path());
  const CalibratedRig read = read_calibrated_rig(folder.path(), {});
  expect_alike(read.rig, flight.rig.rig);
  EXPECT_EQ(read.calibration->right.distortion, flight.rig.calibration->right.distortion);
  expect_same_hits(flight, folder.path(), folder.path() / "found");
}

/// An exposure's middle lies between two steps: the pose there is between theirs.
TEST(EurocRecording, ImagesThatTakeTimeHavePosesOfTheirMoment) {
  const TemporaryFolder folder;
  const Flown flight = flown(short_flight({"cameras.exposure_s=0.0035"}), folder.path());
  const auto poses = read_poses(folder.path() / "mav0/state_groundtruth_estimate0/data.csv");
  for (std::size_t i = 1; i < flight.frames.size(); ++i) {
    const std::int64_t t_ns = flight.frames[i].t_ns;
    std::size_t after = 0;
    while (flight.truths[after].t_ns < t_ns) ++after;
    const Truth &a = flight.truths[after - 1], &b = flight.truths[after];
    EXPECT_NE(b.t_ns, t_ns);
    const double share = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    const auto pose = pose_at(poses, recorded_ns(t_ns));
    ASSERT_TRUE(pose.has_value());
    EXPECT_LT((pose->translation() - (1 - share) * a.T_world_body.translation() -
               share * b.T_world_body.translation())
                  .norm(),
              1e-6);
  }
}

TEST(EurocRecording, DepthIsInMillimetresWhereItFits) {
  const float infinite = std::numeric_limits<float>::infinity();
  const cv::Mat depth_m = (cv::Mat_<float>(1, 7) << 0, 0.0004F, 5.0004F, 65.535F, 65.536F, 500, infinite);
  const cv::Mat depth_mm = depth_in_millimetres(depth_m);
  ASSERT_EQ(depth_mm.type(), CV_16UC1);
  const std::vector<int> expected{0, 0, 5000, 65535, 0, 0, 0};
  for (int i = 0; i < 7; ++i)
    EXPECT_EQ(depth_mm.at<std::uint16_t>(0, i), expected[static_cast<std::size_t>(i)]) << i;
}

TEST(EurocRecording, ARecordingWithoutAFrameIsRefused) {
  const TemporaryFolder folder;
  const Scenario scenario = short_flight();
  const CalibratedRig rig = rig_of(scenario, root / "models");
  EXPECT_THROW(EurocRecording(folder.path(), scenario, rig, 2).finish(), ScenarioError);
}

}  // namespace
}  // namespace understory
