#include "scenarios/recording/euroc_recording.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "scenarios/config/named_seed.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/report/pictures.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

std::string text_of(const char* header, const std::map<std::int64_t, std::string>& lines) {
  std::string text = header;
  for (const auto& [t_ns, line] : lines) text += line;
  return text;
}

}  // namespace

cv::Mat depth_in_millimetres(const cv::Mat& depth_m) {
  cv::Mat millimetres(depth_m.size(), CV_16UC1);
  for (int row = 0; row < depth_m.rows; ++row) {
    const auto* from = depth_m.ptr<float>(row);
    auto* to = millimetres.ptr<std::uint16_t>(row);
    for (int column = 0; column < depth_m.cols; ++column) {
      const double value = std::round(1000.0 * static_cast<double>(from[column]));
      const bool fits = value > 0 && value <= std::numeric_limits<std::uint16_t>::max();
      to[column] = fits ? static_cast<std::uint16_t>(value) : std::uint16_t{0};
    }
  }
  return millimetres;
}

EurocRecording::EurocRecording(const fs::path& folder, const Scenario& scenario, const CalibratedRig& rig,
                               double expected_s, int every)
    : Recording(every),
      folder_(folder / "mav0"),
      rig_(rig.rig),
      truth_every_steps_(physics_rate_hz / scenario.sensors.imu_rate_hz),
      expected_frames_(expected_s * scenario.cameras.rate_hz / every) {
  const Wood wood = course_wood(scenario);
  const std::size_t last_number = wood.scenery == Scenery::plain
                                      ? object_first_obstacle + wood.obstacles.size()
                                      : WoodsNumbers{wood.trees.size()}.alone(scenario.obstacles.size());
  if (last_number > 65'534)
    throw ScenarioError(
        fmt::format("{}: more obstacles than images of objects can number (65534)", scenario.name));
  for (const char* sensor : {"cam0/data", "cam1/data", "depth0/data", "depth1/data", "objects0/data", "imu0",
                             "state_groundtruth_estimate0"})
    prepare_output_folder(folder_ / sensor);

  // The flight's own IMU draws its constants from this seed.
  const ImuConfig& config = scenario.sensors.imu;
  const Imu imu(config, seed_for(scenario.sensor_seed(), "imu"));
  gyro_bias_radps_ = imu.gyro_bias_radps();
  accelerometer_bias_mps2_ = imu.accelerometer_bias_mps2();

  const auto cameras = recorded_cameras(rig);
  const int camera_hz = scenario.cameras.rate_hz;
  write_whole_file(folder_ / "cam0/sensor.yaml", camera_sensor_text(cameras[0], rig_, camera_hz));
  write_whole_file(folder_ / "cam1/sensor.yaml", camera_sensor_text(cameras[1], rig_, camera_hz));
  write_whole_file(folder_ / "depth0/sensor.yaml", depth_sensor_text(rig_, camera_hz, Side::left));
  write_whole_file(folder_ / "depth1/sensor.yaml", depth_sensor_text(rig_, camera_hz, Side::right));
  write_whole_file(folder_ / "objects0/sensor.yaml", objects_sensor_text(rig_, camera_hz));
  write_whole_file(folder_ / "objects0/objects.csv", objects_text(wood));
  write_whole_file(folder_ / "imu0/sensor.yaml", imu_sensor_text(config, scenario.sensors.imu_rate_hz));
  write_whole_file(folder_ / "state_groundtruth_estimate0/sensor.yaml",
                   state_sensor_text("the simulation's truth; biases are the flight's constants"));
}

void EurocRecording::on_step(const Flight& flight) {
  observe(flight.truth());
  if (!flight.clock().imu()) return;
  const std::optional<ImuSample>& sample = flight.newest<ImuSample>();
  if (sample && sample->t_ns == flight.clock().t_ns()) add(*sample);
  add_estimate(flight.state());
  add_sensors(flight);
}

/// At every step of control: what has reached the autopilot since the last one.
void EurocRecording::add_sensors(const Flight& flight) {
  const auto add_newest = [&]<typename Sample>(const char* folder, const std::optional<Sample>& newest) {
    const auto known = newest_ns_.try_emplace(folder, -1).first;
    if (!newest || newest->t_ns <= known->second) return;
    known->second = newest->t_ns;
    sensor_lines_[folder] += sample_line(*newest);
  };
  add_newest("pitot0", flight.newest<PitotSample>());
  add_newest("barometer0", flight.newest<BarometerSample>());
  add_newest("magnetometer0", flight.newest<MagnetometerSample>());
  add_newest("gps0", flight.newest<GpsSample>());
  sensor_lines_["controls0"] += controls_line(flight.clock().t_ns(), flight.controls());
  sensor_lines_["body0"] += body_line(flight.truth());
}

void EurocRecording::add_step(const Truth& truth) {
  if (steps_++ % truth_every_steps_ == 0) add_true_state(truth);
}

void EurocRecording::add_true_state(const Truth& truth) {
  true_states_.try_emplace(truth.t_ns, state_line({truth.t_ns, truth.T_world_body, truth.velocity_world_mps,
                                                   gyro_bias_radps_, accelerometer_bias_mps2_}));
}

void EurocRecording::add(const ImuSample& sample) { imu_lines_ += imu_line(sample); }

void EurocRecording::add_estimate(const State& state) {
  estimates_.try_emplace(state.t_ns, state_line({state.t_ns, state.T_world_body,
                                                 state.T_world_body.linear() * state.velocity_body_mps,
                                                 state.gyro_bias_radps, state.accelerometer_bias_mps2}));
}

void EurocRecording::add_frame(const StereoFrame& frame, const Truth& truth, const TrueView& view) {
  add_true_state(truth);
  const std::string name = fmt::format("{}.png", recorded_ns(frame.t_ns));
  write_picture(folder_ / "cam0/data" / name, frame.left);
  write_picture(folder_ / "cam1/data" / name, frame.right);
  write_picture(folder_ / "depth0/data" / name, depth_in_millimetres(view.depth_m));
  write_picture(folder_ / "depth1/data" / name, depth_in_millimetres(view.right_depth_m));
  write_picture(folder_ / "objects0/data" / name, view.objects);
  image_lines_ += fmt::format("{},{}\n", recorded_ns(frame.t_ns), name);
  for (const char* folder : {"cam0", "cam1", "depth0", "depth1", "objects0"})
    bytes_ +=
        (fs::file_size(folder_ / folder / "data" / name) + 4095) / 4096 * 4096;  // a disk counts in blocks
  if (const std::int64_t written = frames() + 1; written == 10 || written % 120 == 0) require_room(written);
}

/// That the disk holds what is still to come, by what the frames so far took there.
void EurocRecording::require_room(std::int64_t frames) const {
  const double frame_bytes = static_cast<double>(bytes_) / static_cast<double>(frames);
  const double needed = frame_bytes * (expected_frames_ - static_cast<double>(frames));
  std::error_code error;
  const auto available = static_cast<double>(fs::space(folder_, error).available);
  if (!error && available < needed)
    throw MachineError(
        fmt::format("the recording needs up to {:.3g} GB more ({:.0f} frames, {:.0f} kB each so far), {:.3g} "
                    "GB are free there",
                    needed * 1e-9, expected_frames_, frame_bytes * 1e-3, available * 1e-9));
}

void EurocRecording::finish() {
  require_frames(folder_.parent_path());
  for (const char* camera : {"cam0", "cam1", "depth0", "depth1", "objects0"})
    write_whole_file(folder_ / camera / "data.csv", image_header + image_lines_);
  write_whole_file(folder_ / "imu0/data.csv", imu_header + imu_lines_);
  write_whole_file(folder_ / "state_groundtruth_estimate0/data.csv", text_of(state_header, true_states_));
  for (const auto& [sensor, lines] : sensor_lines_) {
    prepare_output_folder(folder_ / sensor);
    write_whole_file(folder_ / sensor / "data.csv", sample_header(sensor) + lines);
  }
  if (!estimates_.empty()) {
    prepare_output_folder(folder_ / "estimate0");
    write_whole_file(folder_ / "estimate0/sensor.yaml",
                     state_sensor_text("what the flight's own estimator believed at the time"));
    write_whole_file(folder_ / "estimate0/data.csv", text_of(state_header, estimates_));
  }
}

}  // namespace understory
