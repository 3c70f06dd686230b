#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "perception/obstacle_detector.hpp"
#include "planning/flight_model.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/scenario/scenario.hpp"

/// What takes the place of a part of the stack from a moment on (docs/explain.md): the scenario's `ideal`.
namespace understory {

/// Whether the scenario makes this part ideal.
bool is_ideal(const Scenario& scenario, std::string_view part);

/// The detector from the moment on: with `sight` all that stands within 40 m, with `detection` every obstacle
/// at the depths that the scenario's detector looks at; null where neither is ideal. All arguments must
/// outlive it.
std::unique_ptr<ObstacleDetector> ideal_detector(const Scenario& scenario, const StereoRig& rig,
                                                 const std::vector<Obstacle>& obstacles,
                                                 const TruthHistory& truth);

/// The scenario's settings of the autopilot from the moment on: a map that forgets and filters nothing, no
/// latency, a search 20 times as long, the planner's seed drawn anew.
AutopilotConfig with_ideal_parts(AutopilotConfig config, const Scenario& scenario);

/// All obstacles within 40 m of the aircraft, in view or not, as points on their surfaces, 0.5 m apart along
/// them, from 4 m below the aircraft to 4 m above it; a frame brings them every 0.25 s.
class AllAround : public ObstacleDetector {
 public:
  AllAround(const StereoRig& rig, const std::vector<Obstacle>& obstacles, const TruthHistory& truth);
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;

 private:
  StereoRig rig_;
  const std::vector<Obstacle>& obstacles_;
  const TruthHistory& truth_;
  std::int64_t next_ns_ = 0;
  std::vector<StereoHit> hits_;
};

/// Frame by frame, by the moment of exposure, ns.
using KnownHits = std::map<std::int64_t, std::vector<StereoHit>>;

/// As the file of `ideal.hits` holds them, exactly. Reading throws ScenarioError in one line.
std::string to_bytes(const KnownHits& hits);
KnownHits known_hits_from_bytes(const std::string& bytes, const std::string& name);

/// The hits of frames that an earlier flight looked at, so that their images need not be drawn; for frames
/// exposed from `until_ns` on, the detector's own. A frame that the earlier flight left out has no hits.
class KnownDetector : public ObstacleDetector {
 public:
  KnownDetector(KnownHits known, std::int64_t until_ns, std::unique_ptr<ObstacleDetector> then)
      : known_(std::move(known)), until_ns_(until_ns), then_(std::move(then)) {}
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    return frame.t_ns < until_ns_ ? known_[frame.t_ns] : then_->detect(frame);
  }
  /// From now on another one, for the frames that have no known hits.
  void replace(std::unique_ptr<ObstacleDetector> then) { then_ = std::move(then); }

 private:
  KnownHits known_;
  std::int64_t until_ns_;
  std::unique_ptr<ObstacleDetector> then_;
};

/// The body's attitude and place in the reduced model's state: the inverse of flight_state().
Eigen::Isometry3d pose_of(const FlightState& state);

}  // namespace understory
