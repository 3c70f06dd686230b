#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "estimation/state_source.hpp"
#include "perception/io/calibration/calibration_file.hpp"
#include "perception/obstacle_detector.hpp"
#include "planning/autopilot.hpp"
#include "scenarios/flight/flight_computer.hpp"
#include "scenarios/flight/onboard_sensors.hpp"
#include "scenarios/flight/referee.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/aircraft.hpp"
#include "sim/cameras/stereo_cameras.hpp"
#include "sim/render/renderer_kind.hpp"
#include "sim/scene/leaf_contact.hpp"
#include "sim/scene/world.hpp"

namespace understory {

class Flight;

/// Observes a flight: a record, a film, a data set, a page. It can read everything of the flight at each call
/// and cannot change it.
class FlightObserver {
 public:
  virtual ~FlightObserver() = default;

  /// Whether images must be rendered even where no detector looks at them. Called once, before the flight.
  virtual bool needs_images() const { return false; }
  /// Whether it looks at the frame that is exposed now. Frames that nobody looks at are not rendered.
  virtual bool wants_frame() const { return needs_images(); }
  /// The stage of result.json to which its wall time counts; a literal.
  virtual const char* stage() const { return "record"; }

  /// The autopilot has processed flight.frame(): hits and map are up to date.
  virtual void on_frame(const Flight&) {}
  /// Everything of this step is done except the physics.
  virtual void on_step(const Flight&) {}
  /// The flight has ended at truth(). Once.
  virtual void on_end(const Flight&) {}
};

/// What a flight takes from the machine and not from the scenario.
struct FlightMachine {
  std::filesystem::path models_folder;
  RendererKind renderer = RendererKind::osmesa;
};

/// Parts that a program hands to a flight, in place of those that the scenario names. Null: the scenario's.
struct FlightParts {
  std::unique_ptr<ObstacleDetector> detector = nullptr;
  std::unique_ptr<StateSource> state_source = nullptr;
  std::unique_ptr<Planner> planner = nullptr;
  /// Flies in place of the planner. Null where the scenario names no actions: the planner flies.
  std::unique_ptr<Pilot> pilot = nullptr;
};

/// A flight that a program can hold, step and read. Its scenario alone decides it; observers and other
/// flights in this process, earlier or open now, have no effect. Flights may be open side by side on one
/// thread, with one renderer: MuJoCo's OpenGL functions are one per process, and the other renderer is
/// refused.
class Flight {
 public:
  /// Starts on the catapult, before the first step. Observers are called in their order and must outlive the
  /// flight. Throws ScenarioError, in one line, at bad input (rig, launch), MachineError where the machine
  /// fails (models, GL library).
  Flight(const Scenario& scenario, const FlightMachine& machine, std::vector<FlightObserver*> observers = {},
         FlightParts parts = {});
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;

  /// Does everything due at clock(), then one step of physics. Does nothing after the flight has ended.
  void step();

  const Scenario& scenario() const { return scenario_; }
  const CalibratedRig& rig() const { return rig_; }
  const std::vector<Obstacle>& obstacles() const { return world_.obstacles; }

  /// The time of truth(). After step() it is the next step, for which nothing has been done yet.
  const FlightClock& clock() const { return clock_; }
  bool launched() const { return aircraft_.launched(); }  ///< has left the catapult
  const std::optional<Outcome>& outcome() const { return outcome_; }

  const Truth& truth() const { return aircraft_.truth(); }
  Touch touch() const { return aircraft_.touch(); }  ///< what the aircraft touches at truth()
  bool in_leaves() const;                            ///< whether the wing overlaps drawn leaves at truth()
  AircraftShape aircraft_shape() const { return aircraft_.shape(); }
  /// The newest truth not later than t_ns, for 0.6 s back.
  const Truth& truth_at(std::int64_t t_ns) const { return history_.at(t_ns); }

  /// The newest sample of its kind that has reached the autopilot, faults included: ImuSample, PitotSample,
  /// BarometerSample, MagnetometerSample or GpsSample.
  template <typename Sample>
  const std::optional<Sample>& newest() const {
    return sensors_.newest<Sample>();
  }
  /// The newest frame that has reached the autopilot; its images are empty where nothing looks at them.
  const StereoFrame& frame() const { return frame_; }
  const std::vector<StereoHit>& hits() const { return autopilot_.hits(); }  ///< in that frame
  const State& state() const { return autopilot_.state(); }
  /// Whether the autopilot has detected the launch and gives controls, or takes them from a pilot.
  bool in_flight() const { return autopilot_.in_flight(clock_.t_ns()); }
  State state_at(std::int64_t t_ns) const { return parts_.state_source->state_at(t_ns); }
  const LocalMap& map() const { return autopilot_.map(); }
  const Plan& plan() const { return autopilot_.plan(); }
  PlannerCounts planner_counts() const { return autopilot_.counts(); }
  const Controls& controls() const { return controls_; }  ///< in force

  /// To draw the truth beside the images; null where neither detector nor observer needs images.
  const StereoCameras* cameras() const { return cameras_.get(); }
  /// Wall time of each stage until now, and since the flight was made.
  const Stopwatch& stopwatch() const { return stopwatch_; }

 private:
  FlightParts with_rest(FlightParts parts) const;
  void begin_ideal();
  bool is_ideal_now(std::string_view part) const;
  AutopilotConfig autopilot_config() const;  ///< now
  void follow_map_fault();
  std::optional<Eigen::Vector3d> place_of(const ObstaclePoint& point) const;
  const Faults& faults() const { return sensors_.faults(); }
  /// Of a frame whose exposure ends at t_ns, until the computer has it.
  std::int64_t latency_ns(std::int64_t t_ns) const;
  Controls controls_in_force() const;  ///< at the elevons
  void sense();
  void expose();
  bool is_looked_at() const;
  void process(StereoFrame frame);
  void act();
  void tell(void (FlightObserver::*event)(const Flight&));
  void follow_plan();
  void advance();

  Stopwatch stopwatch_;
  Scenario scenario_;
  std::vector<FlightObserver*> observers_;
  bool has_own_detector_;  ///< was handed over
  CalibratedRig rig_;
  World world_;
  Aircraft aircraft_;
  std::optional<LeafContact> leaves_;  ///< of woods
  std::unique_ptr<StereoCameras> cameras_;
  OnboardSensors sensors_;
  FrameDrops drops_;
  FlightComputer computer_;
  TruthHistory history_;
  bool ideal_ = false;    ///< the scenario's ideal parts are in place
  bool forgets_ = false;  ///< the map, by a fault
  std::int64_t last_arrival_ns_ = 0;
  FlightModel plans_model_;             ///< as the planner believes
  std::optional<FlightState> carried_;  ///< of that model, where tracking is ideal
  /// From where the estimate places a frame's points to their true places, by the frame's moment.
  std::map<std::int64_t, Eigen::Isometry3d> T_true_estimated_;
  FlightParts parts_;
  Autopilot autopilot_;
  Referee referee_;
  FlightClock clock_;
  StereoFrame frame_;
  Controls controls_;
  std::optional<Outcome> outcome_;
};

// Makes the parts of a flight from a scenario. All throw in one line.

/// The compiled scene. MachineError where the project's models do not compile.
World world_of(const Scenario& scenario, const std::filesystem::path& models_folder);

/// Its cameras, on `rig` of rig_of. MachineError where no GL library can be loaded.
std::unique_ptr<StereoCameras> cameras_of(const Scenario& scenario, const World& world,
                                          const CalibratedRig& rig, RendererKind renderer);

/// Its aircraft on the catapult; `world` must outlive it. ScenarioError where the catapult would begin
/// underground.
Aircraft aircraft_of(const Scenario& scenario, const World& world);

/// The detector. ScenarioError if the rig cannot show the depths that the detector compares. All arguments
/// must outlive it.
std::unique_ptr<ObstacleDetector> detector_of(const Scenario& scenario, const CalibratedRig& rig,
                                              const std::vector<Obstacle>& obstacles,
                                              const TruthHistory& history);

/// The autopilot's source of state. All arguments must outlive it.
std::unique_ptr<StateSource> state_source_of(const Scenario& scenario, const CalibratedRig& rig,
                                             const std::vector<Obstacle>& obstacles,
                                             const TruthHistory& history);

/// The planner.
std::unique_ptr<Planner> planner_of(const Scenario& scenario);

/// Flies the actions of autopilot.actions; null if that is empty. ScenarioError if the file cannot be read.
std::unique_ptr<Pilot> pilot_of(const Scenario& scenario);

AutopilotConfig autopilot_config_of(const Scenario& scenario, const StereoRig& rig);

}  // namespace understory
