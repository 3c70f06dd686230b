#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "perception/stereo_frame.hpp"

namespace understory {

/// What a pair costs the aircraft's computer, in simulated time, never measured during a flight. Off: every
/// frame is looked at without delay. docs/thesis.md has the source of the numbers.
struct ComputeConfig {
  bool enabled = false;
  /// Time on the aircraft's computer for one thread's time on the machine the costs below were measured on,
  /// 0.001 .. 1000. 8.3: the original detector, 1.0 ms there, filled the 8.3 ms of a frame at 120 Hz on all
  /// cores of a 1.7 GHz quad ARM Cortex-A9 (Barry & Tedrake 2015). A larger factor is a slower computer.
  double factor = 8.3;
  double pushbroom_s = 0.0010;    ///< 0 .. 1; the original, rectification included (docs/sources.md [17])
  double stereo_bm_s = 0.0090;    ///< StereoBM, 112 disparities (paper's rig, a Zen 4 core, November 2026)
  double stereo_sgbm_s = 0.0127;  ///< StereoSGBM likewise, five paths
};

template <typename Visitor>
void visit_fields(Visitor& visit, ComputeConfig& config) {
  visit("enabled", config.enabled);
  visit("factor", config.factor, 0.001, 1000.0);
  visit("pushbroom_s", config.pushbroom_s, 0.0, 1.0);
  visit("stereo_bm_s", config.stereo_bm_s, 0.0, 1.0);
  visit("stereo_sgbm_s", config.stereo_sgbm_s, 0.0, 1.0);
}

/// The computer between cameras and autopilot. When it is free, it takes the newest frame that has arrived,
/// is busy for the detector's cost, and then hands the frame over. Of the frames that arrive meanwhile only
/// the newest is kept. With no cost it hands over every frame as it arrives. Exact to the nanosecond,
/// whatever the step size. Frames come in order of arrival.
class FlightComputer {
 public:
  explicit FlightComputer(std::int64_t cost_ns) : cost_ns_(cost_ns) {}

  /// Whether a frame with this arrival will be looked at, given that the next arrives at `next_arrival_ns`
  /// and later ones at the same interval. The caller may leave other frames empty. To be called once for
  /// every frame, in order.
  bool will_take(std::int64_t arrival_ns, std::int64_t next_arrival_ns);

  /// Adds a frame, not later than its arrival.
  void send(StereoFrame frame, std::int64_t arrival_ns);
  /// The next frame that has been looked at by t_ns; to be called until there is none. t_ns never decreases,
  /// and frames that arrived by then have been sent.
  std::optional<StereoFrame> looked_at(std::int64_t t_ns);

 private:
  struct Arrival {
    StereoFrame frame;
    std::int64_t t_ns = 0;
  };

  std::int64_t cost_ns_;
  std::deque<Arrival> arrivals_;  // the first is being looked at where busy_
  bool busy_ = false;
  std::int64_t free_ns_ = 0;          // end of the newest frame that was taken
  std::int64_t planned_free_ns_ = 0;  // the same as predicted by will_take
};

}  // namespace understory
