#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planning/plan.hpp"

namespace understory {

/// A running 64-bit hash of everything a flight produced, bit for bit. Equal scenario, seed and binary give
/// equal digests on one machine. Eight bytes at a time are folded in by splitmix64's mixer (Steele, Lea &
/// Flood 2014): not cryptographic, but every bit of every word reaches every bit of the result. Images go
/// into eight chains side by side, the words in turn, which are then folded in themselves.
class RunDigest {
 public:
  void add(std::uint64_t word);
  void add(double value);
  void add(const Eigen::Isometry3d& pose);
  void add(std::span<const std::byte> bytes);
  std::string hex() const;

 private:
  std::uint64_t state_ = 0x6a09e667f3bcc908u;
};

/// How a flight ended.
enum class Outcome {
  goal,           ///< passed the goal plane
  collision,      ///< touched an obstacle (MuJoCo's own contact)
  ground,         ///< touched the ground
  out_of_bounds,  ///< left the altitude band after climbing into it, or the course's sides
  time            ///< ran out of simulated time
};

std::string_view word_for(Outcome outcome);
/// Whether an outcome is called so.
bool is_ending(std::string_view word);

/// Wall time of one stage of the loop, for people. It decides nothing.
struct StageTiming {
  std::string stage;
  std::int64_t count = 0;
  double total_s = 0;
  double maximum_s = 0;
};

/// One flight in numbers: what result.json holds.
struct FlightResult {
  std::string scenario;             ///< its name
  std::uint64_t seed = 0;           ///< of the course
  std::uint64_t sensor_seed = 0;    ///< of the sensors' noise
  std::string detector;             ///< perception.detector
  std::string state_source;         ///< estimation.source
  Outcome outcome = Outcome::time;  ///< goal, collision, ground, out_of_bounds or time
  std::string touched;              ///< name of the nearest obstacle at a collision
  double simulated_s = 0;           ///< since the start at rest
  double wall_s = 0;                ///< that the flight took on its machine
  double distance_m = 0;            ///< true path length since release
  double progress_m = 0;            ///< maximum true x reached
  double mean_speed_mps = 0;        ///< true, over ground, since release
  /// True; +infinity without obstacles (null in JSON).
  double minimum_clearance_m = std::numeric_limits<double>::infinity();
  double position_error_mean_m = 0;    ///< estimate against truth, since release
  double position_error_max_m = 0;     ///< the largest
  double position_error_end_m = 0;     ///< at the end
  double attitude_error_max_rad = 0;   ///< the largest, since release
  double velocity_error_mean_mps = 0;  ///< estimate against truth, since release
  std::int64_t frames = 0;             ///< that the stack received
  std::int64_t detections = 0;         ///< hits, all frames
  std::int64_t remembered_points = 0;  ///< points ever taken into the map
  PlannerCounts planner;
  /// For each obstacle of a short course (goalposts): remembered points within 0.5 m of it before it was
  /// passed.
  std::vector<std::pair<std::string, std::int64_t>> points_on_obstacles;
  std::vector<StageTiming> timings;
  std::string renderer;  ///< OpenGL's name of what drew; empty without images
  std::string digest;    ///< of the flight, bit for bit: equal flights have equal digests
};

/// The columns of trajectory.csv, a line.
extern const char* const trajectory_columns;

/// As indented JSON text, versions of program and libraries included.
std::string to_json(const FlightResult& result);

/// One screen for a person.
std::string to_report(const FlightResult& result);

}  // namespace understory
