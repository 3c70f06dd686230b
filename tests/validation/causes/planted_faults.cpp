// Faults of software, planted from a moment on, to prove that understory explain finds them
// (docs/causes.md): a trunk that the detector does not see, points where nothing stands, a step of the
// estimate's heading, a search that is cut short and has no fallback. Each wraps a part of ours.
#include <cmath>
#include <memory>
#include <utility>

#include "scenarios/parts/oracles.hpp"
#include "scenarios/scenario/plugin.hpp"

namespace {

using namespace understory;

struct PlantedConfig {
  double at_s = 1000;
  double yaw_rad = 0.15;
  double iterations_share = 1.0 / 120;
};

template <typename Visitor>
void visit_fields(Visitor& visit, PlantedConfig& config) {
  visit("at_s", config.at_s, 0.0, 1000.0, "simulated time from which the fault acts");
  visit("yaw_rad", config.yaw_rad, -3.2, 3.2, "step of the heading");
  visit("iterations_share", config.iterations_share, 0.0, 1.0,
        "part of the search's iterations that is left");
}

std::int64_t nanoseconds_of(double t_s) { return std::llround(1e9 * t_s); }

/// Of the obstacle's axis, seen from above.
double distance_m(const Eigen::Vector3d& place, const Obstacle& obstacle) {
  return (place - obstacle.from_world).head<2>().norm() - obstacle.radius_m;
}

/// From the moment on it does not see the trunk that stands in the way then, 7 to 20 m ahead.
class Unseeing : public ObstacleDetector {
 public:
  Unseeing(const FlightContext& context, const PlantedConfig& config, std::unique_ptr<ObstacleDetector> ours)
      : truth_(context.truth),
        obstacles_(context.obstacles),
        T_body_camera_(context.rig.rig.T_body_camera),
        at_ns_(nanoseconds_of(config.at_s)),
        ours_(std::move(ours)) {}

  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    hits_ = ours_->detect(frame);
    if (frame.t_ns < at_ns_) return hits_;
    const Truth& now = truth_.at(frame.t_ns);
    if (trunk_ == nullptr) trunk_ = in_the_way(now);
    if (trunk_ == nullptr) return hits_;
    const Eigen::Isometry3d T_world_camera = now.T_world_body * T_body_camera_;
    std::erase_if(hits_, [&](const StereoHit& hit) {
      return distance_m(T_world_camera * hit.position_camera, *trunk_) < 0.6;
    });
    return hits_;
  }

 private:
  const Obstacle* in_the_way(const Truth& now) const {
    const Eigen::Vector2d ahead = now.velocity_world_mps.head<2>().normalized();
    const Obstacle* nearest = nullptr;
    double nearest_m = 20;
    for (const Obstacle& obstacle : obstacles_) {
      const Eigen::Vector2d to = (obstacle.from_world - now.T_world_body.translation()).head<2>();
      const double along_m = to.dot(ahead), aside_m = std::abs(to.x() * ahead.y() - to.y() * ahead.x());
      if (along_m < 7 || along_m > nearest_m || aside_m > 0.3) continue;
      nearest = &obstacle;
      nearest_m = along_m;
    }
    return nearest;
  }

  const TruthHistory& truth_;
  const std::vector<Obstacle>& obstacles_;
  Eigen::Isometry3d T_body_camera_;
  std::int64_t at_ns_;
  std::unique_ptr<ObstacleDetector> ours_;
  const Obstacle* trunk_ = nullptr;
  std::vector<StereoHit> hits_;
};

/// From the moment on it sees a fence where nothing stands: 3 m wide, straight ahead, 6 m away.
class Imagining : public ObstacleDetector {
 public:
  Imagining(const PlantedConfig& config, std::unique_ptr<ObstacleDetector> ours)
      : at_ns_(nanoseconds_of(config.at_s)), ours_(std::move(ours)) {}

  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    hits_ = ours_->detect(frame);
    if (frame.t_ns < at_ns_) return hits_;
    std::vector<StereoHit> all;
    for (double x_m = -4; x_m <= 4; x_m += 0.4)
      for (double y_m = -2; y_m <= 2; y_m += 0.4) all.push_back({{x_m, y_m, 6}, 0, 0, 0, 0, 0, {}});
    all.insert(all.end(), hits_.begin(), hits_.end());
    hits_ = std::move(all);
    return hits_;
  }

 private:
  std::int64_t at_ns_;
  std::unique_ptr<ObstacleDetector> ours_;
  std::vector<StereoHit> hits_;
};

/// From the moment on its heading is wrong by a step.
class Turned : public StateSource {
 public:
  Turned(const PlantedConfig& config, std::unique_ptr<StateSource> ours)
      : at_ns_(nanoseconds_of(config.at_s)), yaw_rad_(config.yaw_rad), ours_(std::move(ours)) {}

  void on(const Sample& sample) override {
    ours_->on(sample);
    if (!pivot_world_ && ours_->state().t_ns >= at_ns_)
      pivot_world_ = ours_->state().T_world_body.translation();
    state_ = turned(ours_->state());
  }
  const State& state() const override { return state_; }
  State state_at(std::int64_t t_ns) const override { return turned(ours_->state_at(t_ns)); }

 private:
  State turned(State state) const {
    if (!pivot_world_ || state.t_ns < at_ns_) return state;
    const Eigen::Isometry3d turn = Eigen::Translation3d(*pivot_world_) *
                                   Eigen::AngleAxisd(yaw_rad_, Eigen::Vector3d::UnitZ()) *
                                   Eigen::Translation3d(-*pivot_world_);
    state.T_world_body = turn * state.T_world_body;
    return state;
  }

  std::int64_t at_ns_;
  double yaw_rad_;
  std::unique_ptr<StateSource> ours_;
  std::optional<Eigen::Vector3d> pivot_world_;
  State state_;
};

/// From the moment on a search has few iterations, and where it finds nothing the flight goes straight on.
class CutShort : public Planner {
 public:
  CutShort(const PlannerPartContext& context, const PlantedConfig& config,
           std::function<std::unique_ptr<Planner>(const PlannerPartContext&)> make)
      : at_ns_(nanoseconds_of(config.at_s)),
        share_(config.iterations_share),
        config_(static_cast<const PlannerContext&>(context).config),
        seed_(context.seed),
        ours_(make(context)) {}

  Plan plan(const PlanRequest& request) override {
    if (!acts_ && request.t_ns >= at_ns_) {
      acts_ = true;
      change(config_, seed_);
    }
    Plan plan = ours_->plan(request);
    counts_ = ours_->counts();
    if (acts_ && plan.origin == PlanOrigin::fallback)
      for (PlanPoint& point : plan.points) point.bank_command_rad = point.climb_command_mps = 0;
    return plan;
  }
  bool concerns(const ObstaclePoint& point, const Plan& plan) const override {
    return ours_->concerns(point, plan);
  }
  void change(const PlannerConfig& config, std::uint64_t seed) override {
    config_ = config;
    seed_ = seed;
    PlannerConfig cut = config;
    if (acts_) {
      for (int* iterations : {&cut.search.iterations, &cut.improvement.iterations})
        *iterations = static_cast<int>(std::ceil(share_ * *iterations));
    }
    ours_->change(cut, seed);
  }

 private:
  std::int64_t at_ns_;
  double share_;
  PlannerConfig config_;
  std::uint64_t seed_;
  bool acts_ = false;
  std::unique_ptr<Planner> ours_;
};

}  // namespace

UNDERSTORY_PLUGIN(parts) {
  const DetectorPart& detector = *parts.detectors.find("pushbroom");
  for (const char* name : {"unseeing", "imagining"}) {
    DetectorPart part;
    part.name = name;
    part.meaning = "the pushbroom detector with a planted fault";
    part.make = [make = detector.make,
                 name](const FlightContext& context) -> std::unique_ptr<ObstacleDetector> {
      const auto& config = own_config<PlantedConfig>(context);
      if (std::string(name) == "unseeing") return std::make_unique<Unseeing>(context, config, make(context));
      return std::make_unique<Imagining>(config, make(context));
    };
    part.depths_m = detector.depths_m;
    parts.detectors.add(std::move(part), PlantedConfig());
  }
  const auto make_filter = parts.state_sources.find("filter")->make;
  parts.state_sources.add({.name = "turned",
                           .meaning = "the filter with a planted step of its heading",
                           .make =
                               [make_filter](const FlightContext& context) {
                                 return std::make_unique<Turned>(own_config<PlantedConfig>(context),
                                                                 make_filter(context));
                               }},
                          PlantedConfig());
  const auto make_sst = parts.planners.find("sst")->make;
  parts.planners.add({.name = "cut_short",
                      .meaning = "the planner sst with a planted cut of its search",
                      .make =
                          [make_sst](const PlannerPartContext& context) {
                            return std::make_unique<CutShort>(context, own_config<PlantedConfig>(context),
                                                              make_sst);
                          }},
                     PlantedConfig());
}
