#include "scenarios/recording/flight_mcap.hpp"

#include <fmt/format.h>
#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <limits>
#include <set>

#include "scenarios/recording/foxglove.pb.h"
#include "scenarios/recording/foxglove_messages.hpp"
#include "scenarios/recording/mcap_file.hpp"
#include "scenarios/recording/understory.pb.h"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

// A little less than the period of 60 and 30 a second, since frames come at whole physics steps.
constexpr std::int64_t image_every_ns = 16'000'000, map_every_ns = 33'000'000;

/// A type's file and all that it imports.
void add_file(const google::protobuf::FileDescriptor& file, std::set<std::string>& known,
              google::protobuf::FileDescriptorSet& files) {
  if (!known.insert(file.name()).second) return;
  for (int i = 0; i < file.dependency_count(); ++i) add_file(*file.dependency(i), known, files);
  file.CopyTo(files.add_file());
}

std::string descriptors_of(const google::protobuf::Descriptor& type) {
  google::protobuf::FileDescriptorSet files;
  std::set<std::string> known;
  add_file(*type.file(), known, files);
  return files.SerializeAsString();
}

}  // namespace

struct FlightMcap::Implementation {
  const FlightLog& log;
  McapFile file;
  template <typename Message>
  std::uint16_t channel(const char* topic) {
    const google::protobuf::Descriptor& type = *Message::descriptor();
    return file.add_channel(topic, type.full_name(), descriptors_of(type));
  }
  void put(std::uint16_t topic, std::int64_t t_ns, const google::protobuf::Message& message) {
    file.add(topic, t_ns, message.SerializeAsString());
  }

  Implementation(const FlightLog& flight_log, const std::filesystem::path& name, bool exact, FolderMark* mark)
      : log(flight_log), file(name, mark), exact_images(exact) {}

  std::uint16_t left_image = channel<foxglove::CompressedImage>("/camera/left/image");
  std::uint16_t right_image = channel<foxglove::CompressedImage>("/camera/right/image");
  std::uint16_t left_calibration = channel<foxglove::CameraCalibration>("/camera/left/calibration");
  std::uint16_t right_calibration = channel<foxglove::CameraCalibration>("/camera/right/calibration");
  std::uint16_t hits = channel<foxglove::PointCloud>("/hits");
  std::uint16_t map = channel<foxglove::PointCloud>("/map");
  std::uint16_t obstacles = channel<foxglove::PointCloud>("/obstacles");
  std::uint16_t crowns = channel<foxglove::PointCloud>("/crowns");
  std::uint16_t transforms = channel<foxglove::FrameTransform>("/tf");
  std::uint16_t plan = channel<foxglove::PosesInFrame>("/plan");
  std::uint16_t true_pose = channel<foxglove::PoseInFrame>("/pose/true");
  std::uint16_t estimated_pose = channel<foxglove::PoseInFrame>("/pose/estimated");
  std::uint16_t scalars = channel<FlightScalars>("/scalars");
  std::uint16_t texts = channel<foxglove::Log>("/log");

  // A crown is large, and only a picture.
  std::vector<Eigen::Vector3d> crown_points = surface_points(course_crowns(log.scenario), 0.8);
  std::vector<Eigen::Vector3d> obstacle_points;  // of log.obstacles, made once

  // What has been written of the log.
  std::size_t frames = 0, plans = 0, moments = 0;
  bool exact_images;
  std::int64_t next_begin_ns = 0, next_map_ns = 0, next_image_ns = 0, map_points = 0;
  bool launched = false, fell_back = false;

  void say(std::int64_t t_ns, foxglove::Log::Level level, const std::string& text) {
    foxglove::Log message;
    set_time(message.mutable_timestamp(), t_ns);
    message.set_level(level);
    message.set_message(text);
    message.set_name("understory");
    put(texts, t_ns, message);
  }
  void begin(std::int64_t t_ns);
  void put_frame(const LogFrame& frame);
  void put_plan(const LogPlan& plan);
  void put_moment(const LogMoment& moment);
  void put_outcome();
  void catch_up(std::int64_t until_ns);
};

/// What does not change: again with every second, so that one can look at any part of the file.
void FlightMcap::Implementation::begin(std::int64_t t_ns) {
  put(transforms, t_ns, transform("world", "odometry", Eigen::Isometry3d::Identity(), t_ns));
  put(transforms, t_ns, transform("aircraft", "left_rectified", log.rig.rig.T_body_camera, t_ns));
  for (const bool is_left : {true, false})
    put(transforms, t_ns,
        transform("aircraft", is_left ? "left_camera" : "right_camera", camera_pose(log.rig, is_left), t_ns));
  put(left_calibration, t_ns, calibration_of(log.rig, true, t_ns));
  put(right_calibration, t_ns, calibration_of(log.rig, false, t_ns));
  if (obstacle_points.empty()) obstacle_points = surface_points(log.obstacles, 0.1);
  put(obstacles, t_ns, cloud("world", obstacle_points, t_ns));
  put(crowns, t_ns, cloud("world", crown_points, t_ns));
  if (moments == 0)
    say(t_ns, foxglove::Log::INFO, fmt::format("scenario {}, seed {}", log.scenario.name, log.scenario.seed));
}

/// A viewer orders by the time at which something was known; the hits bear the time of the exposure.
void FlightMcap::Implementation::put_frame(const LogFrame& frame) {
  const auto first = log.hits_camera.begin() + frame.first_hit;
  put(hits, frame.arrival_ns, cloud("left_rectified", {first, first + frame.hits}, frame.t_ns));
  if (frame.arrival_ns < next_map_ns) return;
  next_map_ns = frame.arrival_ns + map_every_ns;
  std::vector<Eigen::Vector3d> remembered;
  for (const LogPoint& one : log.points)
    if (one.from_ns <= frame.arrival_ns && frame.arrival_ns < one.to_ns)
      remembered.push_back(one.point.position_world);
  map_points = static_cast<std::int64_t>(remembered.size());
  put(map, frame.arrival_ns, cloud("odometry", remembered, frame.arrival_ns));
}

void FlightMcap::Implementation::put_plan(const LogPlan& in_force) {
  foxglove::PosesInFrame message;
  set_time(message.mutable_timestamp(), in_force.t_ns);
  message.set_frame_id("odometry");
  for (const Eigen::Vector3d& place : in_force.way_odometry)
    set_pose(message.add_poses(), Eigen::Isometry3d(Eigen::Translation3d(place)));
  put(plan, in_force.t_ns, message);
  const bool falls_back = in_force.origin == PlanOrigin::fallback;
  if (falls_back && !fell_back)
    say(in_force.t_ns, foxglove::Log::WARNING, "the planner found no free way and fell back");
  fell_back = falls_back;
}

void FlightMcap::Implementation::put_moment(const LogMoment& moment) {
  const std::int64_t t_ns = moment.t_ns;
  if (log.launch_ns && *log.launch_ns <= t_ns && !launched)
    say(t_ns, foxglove::Log::INFO, "left the catapult");
  launched = log.launch_ns && *log.launch_ns <= t_ns;
  put(transforms, t_ns, transform("world", "aircraft", moment.T_world_body, t_ns));
  put(transforms, t_ns, transform("odometry", "estimated_aircraft", moment.T_odometry_body, t_ns));
  for (const bool is_true : {true, false}) {
    foxglove::PoseInFrame pose;
    set_time(pose.mutable_timestamp(), t_ns);
    pose.set_frame_id(is_true ? "world" : "odometry");
    set_pose(pose.mutable_pose(), is_true ? moment.T_world_body : moment.T_odometry_body);
    put(is_true ? true_pose : estimated_pose, t_ns, pose);
  }
  const Eigen::Vector3d error_m = position_error_m(moment);
  FlightScalars numbers;
  set_time(numbers.mutable_timestamp(), t_ns);
  numbers.set_speed(moment.velocity_world_mps.norm());
  numbers.set_estimated_speed(moment.estimated_velocity_mps.norm());
  numbers.set_height(moment.T_world_body.translation().z());
  numbers.set_estimated_height(moment.estimated_altitude_m);
  numbers.set_bank(bank_rad(moment.T_world_body));
  numbers.set_commanded_bank(moment.commanded_bank_rad);
  numbers.set_left_elevon(moment.left_elevon_rad);
  numbers.set_right_elevon(moment.right_elevon_rad);
  numbers.set_clearance(moment.clearance_m);
  if (plans > 0) numbers.set_planned_clearance(log.plans[plans - 1].clearance_m);
  numbers.set_position_error_x(error_m.x());
  numbers.set_position_error_y(error_m.y());
  numbers.set_position_error_z(error_m.z());
  numbers.set_position_sigma_x(moment.position_sigma_m.x());
  numbers.set_position_sigma_y(moment.position_sigma_m.y());
  numbers.set_position_sigma_z(moment.position_sigma_m.z());
  numbers.set_hits(frames > 0 ? static_cast<std::uint32_t>(log.frames[frames - 1].hits) : 0);
  numbers.set_map_points(static_cast<std::uint32_t>(map_points));
  put(scalars, t_ns, numbers);
}

void FlightMcap::Implementation::put_outcome() {
  const Outcome outcome = log.result.outcome;
  say(log.moments.back().t_ns, outcome == Outcome::goal ? foxglove::Log::INFO : foxglove::Log::ERROR,
      std::string(word_for(outcome)));
  file.finish();
}

/// Writes what the log has gained, in order of time.
void FlightMcap::Implementation::catch_up(std::int64_t until_ns) {
  constexpr std::int64_t later = std::numeric_limits<std::int64_t>::max(), second_ns = 1'000'000'000;
  while (true) {
    const std::int64_t frame_ns = frames < log.frames.size() ? log.frames[frames].arrival_ns : later;
    const std::int64_t plan_ns = plans < log.plans.size() ? log.plans[plans].t_ns : later;
    const std::int64_t moment_ns = moments < log.moments.size() ? log.moments[moments].t_ns : later;
    const std::int64_t next_ns = std::min({frame_ns, plan_ns, moment_ns});
    if (next_ns == later || next_ns > until_ns) return;
    if (next_begin_ns <= next_ns) {
      begin(next_ns);
      next_begin_ns += second_ns;
    } else if (frame_ns == next_ns) {
      put_frame(log.frames[frames++]);
    } else if (plan_ns == next_ns) {
      put_plan(log.plans[plans++]);
    } else {
      put_moment(log.moments[moments++]);
    }
  }
}

FlightMcap::FlightMcap(const FlightLog& log, const std::filesystem::path& file, bool exact_images,
                       FolderMark* mark)
    : implementation_(std::make_unique<Implementation>(log, file, exact_images, mark)) {}

FlightMcap::~FlightMcap() = default;

void FlightMcap::on_frame(const Flight& flight) {
  Implementation& to = *implementation_;
  const StereoFrame& frame = flight.frame();
  const std::int64_t now_ns = flight.clock().t_ns();
  if (!to.exact_images && frame.t_ns < to.next_image_ns) return;
  to.next_image_ns = frame.t_ns + image_every_ns;
  to.put(to.left_image, now_ns, image_message(frame.left, true, frame.t_ns, to.exact_images));
  to.put(to.right_image, now_ns, image_message(frame.right, false, frame.t_ns, to.exact_images));
}

void FlightMcap::on_step(const Flight& flight) { implementation_->catch_up(flight.clock().t_ns()); }

void FlightMcap::on_end(const Flight& flight) {
  implementation_->catch_up(flight.clock().t_ns());
  implementation_->put_outcome();
}

void FlightMcap::write_whole_log() {
  implementation_->catch_up(std::numeric_limits<std::int64_t>::max() - 1);
  implementation_->put_outcome();
}

}  // namespace understory
