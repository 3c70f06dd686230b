#pragma once

#include <cstdint>
#include <vector>

#include "estimation/samples.hpp"
#include "estimation/state_source.hpp"
#include "perception/map/local_map.hpp"
#include "perception/map/resightings.hpp"
#include "perception/obstacle_detector.hpp"
#include "perception/stereo_rig.hpp"
#include "planning/airframe.hpp"
#include "planning/autopilot_config.hpp"
#include "planning/path_follower.hpp"
#include "planning/pilot.hpp"
#include "planning/planner.hpp"

namespace understory {

/// The flight stack composed: the part of this program that would run on the aircraft. `detector` detects
/// obstacles, `state_source` estimates the state, `planner` plans the path. All three must outlive it.
class Autopilot {
 public:
  Autopilot(const AutopilotConfig& config, const Airframe& airframe, const StereoRig& rig,
            ObstacleDetector& detector, StateSource& state_source, Planner& planner);
  /// From now on `pilot`, which must outlive this, gives the controls; no plans are made.
  void hand_over(Pilot& pilot) { pilot_ = &pilot; }

  /// From now on these settings of map and latency, and these parts, which must outlive this; map, plan and
  /// launch stay. `place` moves the map's points, or forgets them; null: they stay.
  void change(const AutopilotConfig& config, ObstacleDetector& detector, StateSource& state_source,
              Planner& planner, const LocalMap::Place& place);

  void on(const Sample& sample);
  void on(const StereoFrame& frame);
  /// Plans for the moment at which the plan will take effect. Does nothing while a plan is being computed
  /// (plan_latency_s), so calling more often changes nothing. Does nothing either while the plan in force is
  /// younger than its period and no new point lies near it.
  void replan(std::int64_t t_ns);
  Controls controls(std::int64_t t_ns);

  bool in_flight(std::int64_t t_ns) const;
  const State& state() const { return state_source_->state(); }
  const std::vector<StereoHit>& hits() const { return hits_; }  ///< of the newest frame
  const LocalMap& map() const { return map_; }
  const Plan& plan() const { return plan_; }
  PlannerCounts counts() const;

 private:
  bool concerns_the_plan(std::int64_t t_ns) const;

  AutopilotConfig config_;
  StereoRig rig_;
  ObstacleDetector* detector_;
  StateSource* state_source_;
  FlightModel model_;
  Planner* planner_;
  Pilot* pilot_ = nullptr;  ///< null: planner and path follower fly
  LocalMap map_;
  Resightings resightings_;
  std::vector<StereoHit> hits_;
  Plan plan_;       ///< in force
  Plan next_plan_;  ///< computed, takes effect at next_plan_due_ns_
  std::int64_t next_plan_due_ns_ = -1;
  std::int64_t planned_ns_ = 0;                              ///< when the newest plan was requested
  bool plan_outdated_ = true;                                ///< something new lies near it
  Eigen::Vector2d drift_world_m_ = Eigen::Vector2d::Zero();  ///< newest GPS position less the odometry's
  std::int64_t launch_ns_ = -1;                              ///< when the launch was detected; -1 before
  int strong_samples_ = 0;
  std::int64_t map_points_ = 0, late_plans_ = 0;  ///< of all plans
};

}  // namespace understory
