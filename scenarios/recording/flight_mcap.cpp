#include "scenarios/recording/flight_mcap.hpp"

#include <fmt/format.h>
#include <google/protobuf/descriptor.pb.h>

#include <set>

#include "scenarios/flight/flight_track.hpp"
#include "scenarios/recording/foxglove.pb.h"
#include "scenarios/recording/foxglove_messages.hpp"
#include "scenarios/recording/mcap_file.hpp"
#include "scenarios/recording/understory.pb.h"

namespace understory {
namespace {

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
  McapFile file;
  template <typename Message>
  std::uint16_t channel(const char* topic) {
    const google::protobuf::Descriptor& type = *Message::descriptor();
    return file.add_channel(topic, type.full_name(), descriptors_of(type));
  }
  void put(std::uint16_t topic, std::int64_t t_ns, const google::protobuf::Message& message) {
    file.add(topic, t_ns, message.SerializeAsString());
  }

  Implementation(const std::filesystem::path& name, bool compress, Named named)
      : file(name, compress, named) {}

  std::uint16_t left_image = channel<foxglove::CompressedImage>("/camera/left/image");
  std::uint16_t right_image = channel<foxglove::CompressedImage>("/camera/right/image");
  std::uint16_t left_calibration = channel<foxglove::CameraCalibration>("/camera/left/calibration");
  std::uint16_t right_calibration = channel<foxglove::CameraCalibration>("/camera/right/calibration");
  std::uint16_t hits = channel<foxglove::PointCloud>("/hits");
  std::uint16_t map = channel<foxglove::PointCloud>("/map");
  std::uint16_t obstacles = channel<foxglove::PointCloud>("/obstacles");
  std::uint16_t transforms = channel<foxglove::FrameTransform>("/tf");
  std::uint16_t plan = channel<foxglove::PosesInFrame>("/plan");
  std::uint16_t true_pose = channel<foxglove::PoseInFrame>("/pose/true");
  std::uint16_t estimated_pose = channel<foxglove::PoseInFrame>("/pose/estimated");
  std::uint16_t scalars = channel<FlightScalars>("/scalars");
  std::uint16_t log = channel<foxglove::Log>("/log");

  std::int64_t plan_t_ns = -1;
  bool begun = false, launched = false, fell_back = false;

  void say(std::int64_t t_ns, foxglove::Log::Level level, const std::string& text) {
    foxglove::Log message;
    set_time(message.mutable_timestamp(), t_ns);
    message.set_level(level);
    message.set_message(text);
    message.set_name("understory");
    put(log, t_ns, message);
  }
  void begin(const Flight& flight);
  void put_plan(const Flight& flight);
  void put_moment(const Flight& flight);
};

/// What does not change: again with every second, so that one can look at any part of the file.
void FlightMcap::Implementation::begin(const Flight& flight) {
  const std::int64_t t_ns = flight.clock().t_ns();
  const StereoRig& rig = flight.rig().rig;
  put(transforms, t_ns, transform("world", "odometry", Eigen::Isometry3d::Identity(), t_ns));
  put(transforms, t_ns, transform("aircraft", "left_rectified", rig.T_body_camera, t_ns));
  for (const bool is_left : {true, false})
    put(transforms, t_ns,
        transform("aircraft", is_left ? "left_camera" : "right_camera", camera_pose(flight.rig(), is_left),
                  t_ns));
  put(left_calibration, t_ns, calibration_of(flight.rig(), true, t_ns));
  put(right_calibration, t_ns, calibration_of(flight.rig(), false, t_ns));
  put(obstacles, t_ns, cloud("world", surface_points(flight.obstacles()), t_ns));
  if (!begun)
    say(t_ns, foxglove::Log::INFO,
        fmt::format("scenario {}, seed {}", flight.scenario().name, flight.scenario().seed));
  begun = true;
}

void FlightMcap::Implementation::put_plan(const Flight& flight) {
  if (flight.plan().t_ns == plan_t_ns || flight.plan().points.empty()) return;
  plan_t_ns = flight.plan().t_ns;
  const std::int64_t t_ns = flight.clock().t_ns();
  foxglove::PosesInFrame message;
  set_time(message.mutable_timestamp(), t_ns);
  message.set_frame_id("odometry");
  for (const Eigen::Vector3d& position_world : planned_way_world(flight))
    set_pose(message.add_poses(), Eigen::Isometry3d(Eigen::Translation3d(position_world)));
  put(plan, t_ns, message);
  const bool falls_back = flight.plan().origin == PlanOrigin::fallback;
  if (falls_back && !fell_back)
    say(t_ns, foxglove::Log::WARNING, "the planner found no free way and fell back");
  fell_back = falls_back;
}

void FlightMcap::Implementation::put_moment(const Flight& flight) {
  const std::int64_t t_ns = flight.clock().t_ns();
  const TrackMoment moment = moment_of(flight);
  put(transforms, t_ns, transform("world", "aircraft", moment.T_world_true, t_ns));
  put(transforms, t_ns, transform("odometry", "estimated_aircraft", moment.T_world_estimated, t_ns));
  for (const bool is_true : {true, false}) {
    foxglove::PoseInFrame pose;
    set_time(pose.mutable_timestamp(), t_ns);
    pose.set_frame_id(is_true ? "world" : "odometry");
    set_pose(pose.mutable_pose(), is_true ? moment.T_world_true : moment.T_world_estimated);
    put(is_true ? true_pose : estimated_pose, t_ns, pose);
  }
  FlightScalars numbers;
  set_time(numbers.mutable_timestamp(), t_ns);
  numbers.set_speed(moment.speed_mps);
  numbers.set_estimated_speed(moment.estimated_speed_mps);
  numbers.set_height(moment.T_world_true.translation().z());
  numbers.set_estimated_height(moment.estimated_altitude_m);
  numbers.set_bank(moment.bank_rad);
  numbers.set_commanded_bank(moment.commanded_bank_rad);
  numbers.set_left_elevon(moment.left_elevon_rad);
  numbers.set_right_elevon(moment.right_elevon_rad);
  numbers.set_clearance(moment.clearance_m);
  numbers.set_planned_clearance(flight.plan().clearance_m);
  numbers.set_position_error_x(moment.position_error_world.x());
  numbers.set_position_error_y(moment.position_error_world.y());
  numbers.set_position_error_z(moment.position_error_world.z());
  numbers.set_position_sigma_x(moment.position_sigma_world.x());
  numbers.set_position_sigma_y(moment.position_sigma_world.y());
  numbers.set_position_sigma_z(moment.position_sigma_world.z());
  numbers.set_hits(static_cast<std::uint32_t>(moment.hits));
  numbers.set_map_points(static_cast<std::uint32_t>(flight.map().points().size()));
  put(scalars, t_ns, numbers);
}

FlightMcap::FlightMcap(const std::filesystem::path& file, bool compress, Named named)
    : implementation_(std::make_unique<Implementation>(file, compress, named)) {}

FlightMcap::~FlightMcap() = default;

void FlightMcap::on_frame(const Flight& flight) {
  Implementation& to = *implementation_;
  const StereoFrame& frame = flight.frame();
  // A viewer orders by the time at which something was known; the messages bear the time of the exposure.
  const std::int64_t now_ns = flight.clock().t_ns();
  to.put(to.left_image, now_ns, image_message(frame.left, true, frame.t_ns));
  to.put(to.right_image, now_ns, image_message(frame.right, false, frame.t_ns));
  std::vector<Eigen::Vector3d> points;
  for (const StereoHit& hit : flight.hits()) points.push_back(hit.position_camera);
  to.put(to.hits, now_ns, cloud("left_rectified", points, frame.t_ns));
  points.clear();
  for (const ObstaclePoint& point : flight.map().points()) points.push_back(point.position_world);
  to.put(to.map, now_ns, cloud("odometry", points, now_ns));
}

void FlightMcap::on_step(const Flight& flight) {
  Implementation& to = *implementation_;
  if (flight.clock().step() % physics_rate_hz == 0) to.begin(flight);
  if (flight.launched() && !to.launched)
    to.say(flight.clock().t_ns(), foxglove::Log::INFO, "left the catapult");
  to.launched = flight.launched();
  to.put_plan(flight);
  if (flight.clock().step() % (physics_rate_hz / 120) == 0) to.put_moment(flight);
}

void FlightMcap::on_end(const Flight& flight) {
  Implementation& to = *implementation_;
  to.put_moment(flight);
  const Outcome outcome = flight.outcome().value();
  to.say(flight.clock().t_ns(), outcome == Outcome::goal ? foxglove::Log::INFO : foxglove::Log::ERROR,
         std::string(word_for(outcome)));
  to.file.finish();
}

}  // namespace understory
