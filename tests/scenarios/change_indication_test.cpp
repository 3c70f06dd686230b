#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "estimation/filter.hpp"
#include "perception/io/hit_files.hpp"
#include "perception/io/text_table.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/bench/bench.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/validation/flight_record.hpp"

/// What a change to filter or detector alters shows in review: two tables in tests/data/changes hold what
/// both gave last, and a commit that changes their figures changes the tables with them (the idea is
/// PX4-ECL's change indication). Nothing says that the figures are right; the other tests do. To write the
/// tables anew:
///     UNDERSTORY_WRITE_CHANGES=1 ctest --preset release -R ChangeIndication
namespace understory {
namespace {

const std::filesystem::path folder = UNDERSTORY_SOURCE_DIR "/tests/data/changes";

/// Cells that are numbers may differ by `tolerance`: mathematical functions differ in the last bits by
/// processor.
void expect_unchanged(const std::string& name, const std::string& text, double tolerance) {
  if (std::getenv("UNDERSTORY_WRITE_CHANGES") != nullptr) std::ofstream(folder / name) << text;
  const std::string held = support::content_of(folder / name);
  const auto before = table_lines(held, CellsParted::by_commas, name);
  const auto now = table_lines(text, CellsParted::by_commas, name);
  ASSERT_EQ(before.size(), now.size()) << name << ": this change alters how many lines there are";
  std::size_t changed = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    bool same = before[i].cells.size() == now[i].cells.size();
    for (std::size_t cell = 0; same && cell < now[i].cells.size(); ++cell) {
      const auto one = number_in(before[i].cells[cell]), other = number_in(now[i].cells[cell]);
      same =
          one && other ? std::abs(*one - *other) <= tolerance : before[i].cells[cell] == now[i].cells[cell];
    }
    changed += !same;
  }
  EXPECT_EQ(changed, 0u) << name << ": " << changed << " of " << now.size()
                         << " lines are altered by this change. If it is meant to, write the table anew "
                            "(UNDERSTORY_WRITE_CHANGES=1) and commit it with the change.";
}

/// The real left jog of 2015 as the sensors of an aircraft would have told it: rates and velocities of the
/// record, specific force from the velocities' differences.
TEST(ChangeIndication, TheFiltersStatesOnARecordedFlight) {
  const FlightRecord record = real_left_jog();
  const auto t_ns = [](const FlightMoment& moment) { return nanoseconds(moment.t_s) + 1'000'000'000; };
  FilterConfig config;
  config.start.in_flight = true;
  config.start.position_world_m = record[0].position_world;
  config.start.velocity_body_mps = record[0].velocity_body_mps;
  config.start.roll_rad = record[0].roll_rad();
  config.start.pitch_rad = -record[0].pitch_rad();
  config.start.yaw_rad = record[0].yaw_rad();
  Filter filter(config);
  std::string text =
      "t_s,x_m,y_m,z_m,roll_rad,nose_down_rad,yaw_rad,u_mps,v_mps,w_mps,sigma_xy_m,sigma_yaw_rad\n";
  for (std::size_t i = 0; i + 1 < record.size(); ++i) {
    const FlightMoment &now = record[i], &next = record[i + 1];
    const Eigen::Vector3d acceleration_world =
        (next.R_world_body * next.velocity_body_mps - now.R_world_body * now.velocity_body_mps) /
        (next.t_s - now.t_s);
    filter.on(ThrustSample{t_ns(now), now.controls.thrust_n});
    filter.on(ImuSample{t_ns(now), now.angular_rate_body_radps,
                        now.R_world_body.transpose() * (acceleration_world + Eigen::Vector3d(0, 0, 9.81))});
    if (i % 2 == 0) filter.on(PitotSample{t_ns(now), now.velocity_body_mps.x()});
    if (i % 4 == 0) filter.on(BarometerSample{t_ns(now), now.position_world.z()});
    if (i % 10 != 9) continue;
    const State state = filter.state();
    FlightMoment told;
    told.R_world_body = state.T_world_body.linear();
    const Eigen::Vector3d place = state.T_world_body.translation(), velocity = state.velocity_body_mps;
    const auto sigma = [&](int row) { return std::sqrt(state.covariance(row, row)); };
    text += fmt::format(
        "{:.2f},{:.3f},{:.3f},{:.3f},{:.4f},{:.4f},{:.4f},{:.3f},{:.3f},{:.3f},{:.3f},{:.4f}\n", now.t_s,
        place.x(), place.y(), place.z(), told.roll_rad(), told.pitch_rad(), told.yaw_rad(), velocity.x(),
        velocity.y(), velocity.z(), sigma(position_block), sigma(attitude_block + 2));
  }
  expect_unchanged("filter_states.csv", text, 0.0011);
}

TEST(ChangeIndication, TheDetectorsHitsOnStereoScenes) {
  const CalibratedRig rig = read_calibrated_rig(UNDERSTORY_SOURCE_DIR "/models/rigs/raw/long.xml", {});
  std::vector<FrameHits> frames;
  PushbroomStereo detector(rig, tuned_pushbroom("long"));
  for (const StereoFrame& frame : stereo_scenes(rig, 2, 1))
    frames.push_back({static_cast<std::int64_t>(frames.size()), 0, detector.detect(frame)});
  expect_unchanged("detector_hits.csv", hits_to_csv(frames), 1e-6);
}

}  // namespace
}  // namespace understory
