// A state source of one's own: the filter, with the heading of the magnetometer alone. It wraps a part of
// ours.
#include <cmath>
#include <variant>

#include "scenarios/scenario/plugin.hpp"

namespace {

using namespace understory;

class CompassSource : public StateSource {
 public:
  explicit CompassSource(std::unique_ptr<StateSource> filter) : filter_(std::move(filter)) {}

  void on(const Sample& sample) override {
    filter_->on(sample);
    state_ = turned(filter_->state());
    const auto* field = std::get_if<MagnetometerSample>(&sample);
    if (field == nullptr) return;
    // The field points to north, which is world y, and down.
    const Eigen::Vector3d north_world = filter_->state().T_world_body.linear() * field->field_body_ut;
    const double error_rad = std::atan2(-north_world.x(), north_world.y());
    turn_rad_ += 0.05 * (-error_rad - turn_rad_);
  }
  const State& state() const override { return state_; }
  State state_at(std::int64_t t_ns) const override { return turned(filter_->state_at(t_ns)); }

 private:
  State turned(State state) const {
    state.T_world_body.linear() =
        Eigen::AngleAxisd(turn_rad_, Eigen::Vector3d::UnitZ()) * state.T_world_body.linear();
    return state;
  }
  std::unique_ptr<StateSource> filter_;
  State state_;
  double turn_rad_ = 0;
};

}  // namespace

UNDERSTORY_PLUGIN(parts) {
  // The table holds our parts, too: a plug-in may make them.
  const auto make_filter = parts.state_sources.find("filter")->make;
  parts.state_sources.add({.name = "compass",
                           .meaning = "the filter, with the heading of the magnetometer alone",
                           .make = [make_filter](const FlightContext& context) {
                             return std::make_unique<CompassSource>(make_filter(context));
                           }});
}
