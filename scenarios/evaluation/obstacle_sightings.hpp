#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "scenarios/evaluation/detection_grid.hpp"
#include "scenarios/evaluation/evaluation_frame.hpp"

namespace understory {

/// What became of one obstacle that was passed.
struct ObstacleSighting {
  int object = 0;
  double miss_m = 0;  ///< minimum distance from the path of the rig's centre to the surface
  bool on_the_path =
      false;               ///< straight on, from where it came into view at the depth, a wing would touch it
  int blocks_in_view = 0;  ///< of all frames: blocks of 5x5 px that showed it to both eyes within half a
                           ///< pixel of a depth looked at
  int hits = 0;            ///< true positives within one pixel, before it was passed
  double first_hit_m = 0;  ///< its depth at the first of them; 0: never
  double third_hit_m = 0;  ///< and at the third, when it counts as found (the original's avoidance: 3)
  bool hidden() const {
    return blocks_in_view < 3;
  }  ///< nothing could give three hits: hidden, or not in view
  bool found() const { return hits >= 3; }
};

/// Gathers an algorithm's sightings along one recording, frame by frame.
class ObstacleSightings {
 public:
  /// `objects`: the recording's. The baseline tells the rig's centre from its left camera.
  ObstacleSightings(std::vector<RecordedObject> objects, double baseline_m);

  /// One frame: its expected blocks at one pixel and the hits. Frames without a pose are passed over.
  void add(const EvaluationFrame& frame, const DetectionGrid& grid,
           const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits);
  /// Those that were passed: the path comes nearest to them before its end. In the objects' order.
  std::vector<ObstacleSighting> passed() const;

 private:
  struct Gathered {
    ObstacleSighting sighting;
    std::size_t seen_at = 0;  ///< index into the path of the first block in view
  };
  bool would_touch(const RecordedObject& object, std::size_t at) const;

  std::vector<RecordedObject> objects_;
  double baseline_m_;
  std::vector<Eigen::Vector3d> path_world_;  ///< of the rig's centre
  std::map<int, Gathered> gathered_;
};

}  // namespace understory
