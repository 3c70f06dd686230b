#include "sim/sensors/faults.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

bool in_force(const FaultConfig& fault, std::int64_t t_ns) {
  const std::int64_t from_ns = std::llround(fault.at_s * 1e9);
  return t_ns >= from_ns && t_ns < from_ns + std::llround(fault.duration_s * 1e9);
}

/// Clamps to -limit .. limit.
double cut(double reading, double limit) { return std::clamp(reading, -limit, limit); }
Eigen::Vector3d cut(const Eigen::Vector3d& reading, double limit) {
  return reading.cwiseMax(-limit).cwiseMin(limit);
}

double shifted(double reading, double by) { return reading + by; }
Eigen::Vector3d shifted(const Eigen::Vector3d& reading, double by) { return reading.array() + by; }

void set(double& reading, double value) { reading = value; }
void set(Eigen::Vector3d& reading, double value) { reading.setConstant(value); }

}  // namespace

std::optional<double> Faults::value(FaultySensor sensor, FaultKind kind, std::int64_t t_ns) const {
  const auto fault = std::find_if(schedule_.begin(), schedule_.end(), [&](const FaultConfig& one) {
    return one.sensor == sensor && one.kind == kind && in_force(one, t_ns);
  });
  return fault == schedule_.end() ? std::nullopt : std::optional(fault->value);
}

std::pair<int, int> free_columns(double cover, int width_px) {
  const auto covered = static_cast<int>(std::lround(std::abs(cover) * width_px));
  return cover > 0 ? std::pair(0, width_px - covered) : std::pair(covered, width_px);
}

template <typename Reading>
Reading Faults::altered(FaultySensor sensor, std::int64_t t_ns, Reading reading) const {
  for (const FaultConfig& fault : schedule_) {
    if (fault.sensor != sensor || !in_force(fault, t_ns)) continue;
    if (fault.kind == FaultKind::bias) reading = shifted(reading, fault.value);
    if (fault.kind == FaultKind::saturate) reading = cut(reading, std::abs(fault.value));
    if (fault.kind == FaultKind::block) set(reading, fault.value);
  }
  return reading;
}

template <typename Reading>
Reading Faults::held(bool frozen, Reading reading, std::optional<Reading>& last) const {
  if (!frozen || !last) last = std::move(reading);  // frozen from the first sample on: that one
  return *last;
}

bool Faults::pass(ImuSample& sample) {
  using enum FaultySensor;
  const auto any = [&](FaultySensor part, FaultKind kind) {
    return has(imu, kind, sample.t_ns) || has(part, kind, sample.t_ns);
  };
  if (any(gyro, FaultKind::dropout) || any(accelerometer, FaultKind::dropout)) return false;
  sample.angular_rate_body_radps =
      held(any(gyro, FaultKind::freeze), altered(gyro, sample.t_ns, sample.angular_rate_body_radps),
           last_.angular_rate_body_radps);
  sample.specific_force_body_mps2 = held(any(accelerometer, FaultKind::freeze),
                                         altered(accelerometer, sample.t_ns, sample.specific_force_body_mps2),
                                         last_.specific_force_body_mps2);
  return true;
}

bool Faults::pass(PitotSample& sample) {
  using enum FaultySensor;
  if (has(pitot, FaultKind::dropout, sample.t_ns)) return false;
  sample.airspeed_mps = held(has(pitot, FaultKind::freeze, sample.t_ns),
                             altered(pitot, sample.t_ns, sample.airspeed_mps), last_.airspeed_mps);
  return true;
}

bool Faults::pass(BarometerSample& sample) {
  using enum FaultySensor;
  if (has(barometer, FaultKind::dropout, sample.t_ns)) return false;
  sample.altitude_m = held(has(barometer, FaultKind::freeze, sample.t_ns),
                           altered(barometer, sample.t_ns, sample.altitude_m), last_.altitude_m);
  return true;
}

bool Faults::pass(MagnetometerSample& sample) {
  using enum FaultySensor;
  if (has(magnetometer, FaultKind::dropout, sample.t_ns)) return false;
  sample.field_body_ut = held(has(magnetometer, FaultKind::freeze, sample.t_ns),
                              altered(magnetometer, sample.t_ns, sample.field_body_ut), last_.field_body_ut);
  return true;
}

bool Faults::pass(GpsSample& sample) {
  using enum FaultySensor;
  const std::int64_t t_ns = sample.t_ns;
  if (has(gps, FaultKind::dropout, t_ns)) return false;
  sample.position_world_m = altered(gps, t_ns, sample.position_world_m);
  sample = held(has(gps, FaultKind::freeze, t_ns), sample, last_.fix);
  sample.t_ns = t_ns;
  return true;
}

bool Faults::pass(StereoFrame& frame) {
  using enum FaultySensor;
  const std::int64_t t_ns = frame.t_ns;
  if (has(camera, FaultKind::dropout, t_ns)) return false;
  frame = held(has(camera, FaultKind::freeze, t_ns), std::move(frame), last_.frame);
  frame.t_ns = t_ns;
  if (const auto cover = value(camera, FaultKind::cover, t_ns); cover && !frame.left.empty()) {
    const auto [first, end] = free_columns(*cover, frame.left.cols);
    for (cv::Mat* image : {&frame.left, &frame.right})
      for (const cv::Range& covered : {cv::Range(0, first), cv::Range(end, image->cols)})
        image->colRange(covered).setTo(0);
  }
  return true;
}

}  // namespace understory
