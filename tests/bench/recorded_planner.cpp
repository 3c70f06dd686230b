// Writes what a flight asks its planner, for `understory bench --planner`:
//   understory fly dense --seed 1101 --plugin build/release/tests/bench/recorded_planner.so
//     --set autopilot.method=recorded --set autopilot.recorded.file=dense.csv
// A file of scenarios/library/problems is such files of several flights, one after the other.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <utility>

#include "scenarios/scenario/plugin.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace {

using namespace understory;

struct RecordedConfig {
  std::string file = "problems.csv";
  double from_s = 2;
  int problems = 84;
};

template <typename Visitor>
void visit_fields(Visitor& visit, RecordedConfig& config) {
  visit("file", config.file, "file that is written");
  visit("from_s", config.from_s, 0.0, 600.0, "simulated time from which requests are written");
  visit("problems", config.problems, 1, 100000, "number of requests that are written");
}

std::int64_t mm(double metres) { return std::llround(1e3 * metres); }

using Place = std::array<std::int64_t, 3>;
/// Heights are above the ground, which drifts with the odometry: those of all points move together.
Place place_of(const ObstaclePoint& point) {
  return {mm(point.position_world.x()), mm(point.position_world.y()), mm(point.distance_flown_m)};
}

/// The planner sst, whose requests are written: first the points that no request before has had, then the
/// request with the numbers of its points, consecutive ones as FIRST-LAST.
class Recorded : public Planner {
 public:
  Recorded(const PlannerPartContext& context, const RecordedConfig& config, std::unique_ptr<Planner> ours)
      : config_(config), ours_(std::move(ours)), to_(config.file) {
    to_ << "flight," << context.scenario.seed << '\n';
  }
  Plan plan(const PlanRequest& request) override {
    if (request.t_ns >= 1e9 * config_.from_s && written_ < config_.problems) write(request);
    Plan plan = ours_->plan(request);
    counts_ = ours_->counts();
    return plan;
  }
  bool concerns(const ObstaclePoint& point, const Plan& plan) const override {
    return ours_->concerns(point, plan);
  }

 private:
  /// By how much heights have moved since they were written.
  std::int64_t lift_of(const std::vector<ObstaclePoint>& points) const {
    for (const ObstaclePoint& point : points)
      if (const auto known = known_.find(place_of(point)); known != known_.end())
        return mm(point.position_world.z()) - known->second.second;
    return 0;
  }
  void write(const PlanRequest& request) {
    ++written_;
    std::string numbers;
    int first = -1, last = -2;
    const auto end_run = [&] {
      if (first >= 0)
        numbers += last > first ? fmt::format(" {}-{}", first, last) : fmt::format(" {}", first);
    };
    const std::int64_t lift_mm = lift_of(request.points);
    for (const ObstaclePoint& point : request.points) {
      const auto [known, is_new] = known_.try_emplace(place_of(point), static_cast<int>(known_.size()),
                                                      mm(point.position_world.z()) - lift_mm);
      if (is_new) to_ << fmt::format("point,{},{}\n", fmt::join(known->first, ","), known->second.second);
      const int number = known->second.first;
      if (number != last + 1) end_run(), first = number;
      last = number;
    }
    end_run();
    const FlightState& start = request.start;
    to_ << fmt::format("plan,{},{:d},{},{},{},{},{}", request.t_ns, request.outdated,
                       mm(request.distance_flown_m), lift_mm, mm(start.position_world.x()),
                       mm(start.position_world.y()), mm(start.position_world.z()));
    for (const double number :
         {start.speed_mps, start.heading_rad, start.climb_angle_rad, start.bank_rad, start.roll_rate_radps,
          start.angle_of_attack_rad, start.sideslip_rad, start.yaw_rate_radps})
      to_ << fmt::format(",{:.4f}", number);
    to_ << ',' << (numbers.empty() ? "" : numbers.substr(1)) << std::endl;
  }

  RecordedConfig config_;
  std::unique_ptr<Planner> ours_;
  std::ofstream to_;
  int written_ = 0;
  std::map<Place, std::pair<int, std::int64_t>> known_;  ///< number and height
};

}  // namespace

UNDERSTORY_PLUGIN(parts) {
  const auto make_sst = parts.planners.find("sst")->make;
  parts.planners.add({.name = "recorded",
                      .meaning = "the planner sst, whose requests are written",
                      .make =
                          [make_sst](const PlannerPartContext& context) {
                            return std::make_unique<Recorded>(context, own_config<RecordedConfig>(context),
                                                              make_sst(context));
                          }},
                     RecordedConfig());
}
