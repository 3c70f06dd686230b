#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "scenarios/evaluation/ground_truth.hpp"
#include "scenarios/flight/flight_computer.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {

/// How one obstacle that was passed had been detected.
struct ObstacleSighting {
  int object = 0;
  double miss_m = 0;  ///< minimum distance from the path of the rig's centre to the surface
  /// On a straight path from where it came into view at the depth, a wing would touch it.
  bool on_the_path = false;
  /// Of all frames: blocks of 5x5 px that showed it to both eyes within half a pixel of a depth looked at.
  int blocks_in_view = 0;
  int hits = 0;            ///< true positives within one pixel, before it was passed
  double first_hit_m = 0;  ///< its depth at the first of them; 0: never
  double third_hit_m = 0;  ///< and at the third, when it counts as found (the original's avoidance: 3)
  /// No detector could have three hits: hidden, or not in view.
  bool hidden() const { return blocks_in_view < 3; }
  bool found() const { return hits >= 3; }
};

/// An obstacle that the path passes: the path comes nearest to it before its end.
struct Passing {
  int object = 0;
  double miss_m = 0;  ///< as in ObstacleSighting
};

/// Of the obstacles that the path came within `reach_m` of and that were not hidden: how many, and how many
/// were found. The number of hidden ones is added to `hidden`, if given.
Share found_within(const std::vector<ObstacleSighting>& sightings, double reach_m,
                   std::int64_t* hidden = nullptr);

/// Gathers an algorithm's sightings along one recording, frame by frame.
class ObstacleSightings {
 public:
  /// `objects`: the recording's. The baseline gives the rig's centre from its left camera.
  ObstacleSightings(std::vector<RecordedObject> objects, double baseline_m);

  /// One frame: its expected blocks at one pixel and the hits. Frames without a pose are skipped.
  void add(const EvaluationFrame& frame, const DetectionGrid& grid,
           const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits);
  /// In the objects' order; the same for every algorithm on a recording. Branches are left out: they seldom
  /// matter to an aircraft that avoids the trunk.
  std::vector<Passing> passings() const;
  /// Those that were passed.
  std::vector<ObstacleSighting> passed(const std::vector<Passing>& passings) const;

 private:
  struct Gathered {
    ObstacleSighting sighting;
    std::size_t seen_at = 0;  ///< index into the path of the first block in view
  };
  bool would_touch(int object, std::size_t at) const;

  std::vector<RecordedObject> objects_;
  double baseline_m_;
  std::vector<Eigen::Vector3d> path_world_;  ///< of the rig's centre
  std::map<int, Gathered> gathered_;
};

/// The sightings of an algorithm that processes only as many frames as the aircraft's computer allows.
struct PacedResult {
  std::int64_t frames = 0;
  std::vector<ObstacleSighting> sightings;
};

/// One algorithm's sightings on that computer: of the frames that arrive while it is busy the newest waits,
/// the others are lost. What was in view is counted on every frame all the same, so that an obstacle is not
/// hidden by a slow algorithm.
class PacedSightings {
 public:
  /// `cost_s`: of a frame, on that computer.
  PacedSightings(std::vector<RecordedObject> objects, double baseline_m, double cost_s);

  /// `next_t_ns`: the moment of the frame after this one.
  void add(const EvaluationFrame& frame, std::int64_t next_t_ns, const DetectionGrid& grid,
           const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits);
  PacedResult result(const std::vector<Passing>& passings) const {
    return {frames_, sightings_.passed(passings)};
  }

 private:
  FlightComputer computer_;
  ObstacleSightings sightings_;
  std::int64_t frames_ = 0;
};

}  // namespace understory
