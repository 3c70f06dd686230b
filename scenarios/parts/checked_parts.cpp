#include "scenarios/parts/checked_parts.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "perception/io/text_file.hpp"

namespace understory {
namespace {

constexpr std::chrono::seconds longest_call{20};

/// Ends the process when a call does not return. No simulated time passes meanwhile, so no flight is lost by
/// it.
class Watchdog {
 public:
  static Watchdog& instance() {
    static Watchdog* watchdog = new Watchdog;  // its thread outlives all statics
    return *watchdog;
  }
  void begin(const std::string& call) {
    const std::lock_guard lock(mutex_);
    call_ = call;
    began_ = std::chrono::steady_clock::now();
  }
  void end() {
    const std::lock_guard lock(mutex_);
    call_.clear();
  }

 private:
  Watchdog() {
    std::thread([this] {
      for (;;) {
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        const std::lock_guard lock(mutex_);
        if (call_.empty() || std::chrono::steady_clock::now() - began_ < longest_call) continue;
        fmt::print(stderr, "understory: {}: has not returned for {} s\n", call_, longest_call.count());
        std::fflush(nullptr);
        std::_Exit(3);
      }
    }).detach();
  }
  std::mutex mutex_;
  std::string call_;  // empty: none
  std::chrono::steady_clock::time_point began_;
};

/// Who is called, for messages: "/a/mine.so: detector 'mine': ".
struct Callee {
  std::string name;

  template <typename Made, typename Context>
  Callee(const char* kind, const Part<Made, Context>& part)
      : name(fmt::format("{}: {} '{}': ", part.plugin, kind, part.name)) {}

  [[noreturn]] void fail(const char* call, const std::string& why) const {
    throw MachineError(name + call + " " + why);
  }
  template <typename Function>
  decltype(auto) call(const char* called, Function&& function) const {
    struct Watched {
      explicit Watched(const std::string& what) { Watchdog::instance().begin(what); }
      ~Watched() { Watchdog::instance().end(); }
    } watched(name + called);
    try {
      return function();
    } catch (const InputError&) {
      throw;  // what a person gave it, in its own words
    } catch (const MachineError&) {
      throw;
    } catch (const std::exception& error) {
      fail(called, fmt::format("threw: {}", error.what()));
    } catch (...) {
      fail(called, "threw what is no std::exception");
    }
  }
};

class CheckedDetector : public ObstacleDetector {
 public:
  CheckedDetector(std::unique_ptr<ObstacleDetector> detector, const DetectorPart& part, const StereoRig& rig)
      : detector_(std::move(detector)), callee_("detector", part), rig_(rig) {}

  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    const std::vector<StereoHit>& hits =
        callee_.call("detect()", [&]() -> const std::vector<StereoHit>& { return detector_->detect(frame); });
    int row_px = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const StereoHit& hit = hits[i];
      const auto fail = [&](const std::string& why) {
        callee_.fail("detect()", fmt::format("gave hit {} of {}, {}", i + 1, hits.size(), why));
      };
      if (!hit.position_camera.allFinite() || !std::isfinite(hit.disparity_px)) fail("which is not finite");
      if (hit.position_camera.z() <= 0) fail("which lies behind the camera");
      if (hit.column_px < 0 || hit.column_px >= rig_.width_px || hit.row_px < 0 ||
          hit.row_px >= rig_.height_px)
        fail(fmt::format("at column {} and row {}, outside the image of {}x{}", hit.column_px, hit.row_px,
                         rig_.width_px, rig_.height_px));
      if (hit.row_px < row_px) fail("above the hit before it: hits must come from top to bottom");
      row_px = hit.row_px;
    }
    return hits;
  }

 private:
  std::unique_ptr<ObstacleDetector> detector_;
  Callee callee_;
  StereoRig rig_;
};

class CheckedStateSource : public StateSource {
 public:
  CheckedStateSource(std::unique_ptr<StateSource> source, const StateSourcePart& part)
      : source_(std::move(source)), callee_("state source", part) {}

  void on(const Sample& sample) override {
    callee_.call("on()", [&] { source_->on(sample); });
    const State& now = state();
    check("state() after on()", now);
    if (now.t_ns < newest_ns_) callee_.fail("on()", "moved the time of the state back");
    newest_ns_ = now.t_ns;
  }
  const State& state() const override {
    return callee_.call("state()", [&]() -> const State& { return source_->state(); });
  }
  State state_at(std::int64_t t_ns) const override {
    State state = callee_.call("state_at()", [&] { return source_->state_at(t_ns); });
    check("state_at()", state);
    return state;
  }

 private:
  void check(const char* call, const State& state) const {
    if (!state.T_world_body.matrix().allFinite() || !state.velocity_body_mps.allFinite() ||
        !state.angular_rate_body_radps.allFinite() || !std::isfinite(state.altitude_m) ||
        !std::isfinite(state.distance_flown_m))
      callee_.fail(call, "gave a state that is not finite");
  }
  std::unique_ptr<StateSource> source_;
  Callee callee_;
  std::int64_t newest_ns_ = 0;
};

bool is_finite(const PlanPoint& point) {
  return point.position_world.allFinite() &&
         std::isfinite(point.t_s + point.speed_mps + point.heading_rad + point.climb_angle_rad +
                       point.bank_rad + point.angle_of_attack_rad + point.bank_command_rad +
                       point.climb_command_mps);
}

class CheckedPlanner : public Planner {
 public:
  CheckedPlanner(std::unique_ptr<Planner> planner, const PlannerPart& part)
      : planner_(std::move(planner)), callee_("planner", part) {}

  Plan plan(const PlanRequest& request) override {
    Plan plan = callee_.call("plan()", [&] { return planner_->plan(request); });
    counts_ = planner_->counts();
    if (plan.t_ns != request.t_ns)
      callee_.fail("plan()", fmt::format("gave a plan from {} ns on, asked for one from {} ns on", plan.t_ns,
                                         request.t_ns));
    if (plan.points.size() < 2) callee_.fail("plan()", "gave a plan with fewer than two points");
    for (std::size_t i = 0; i < plan.points.size(); ++i) {
      if (!is_finite(plan.points[i]))
        callee_.fail("plan()", fmt::format("gave point {} of a plan, which is not finite", i + 1));
      if (i == 0 ? plan.points[i].t_s != 0 : plan.points[i].t_s <= plan.points[i - 1].t_s)
        callee_.fail("plan()",
                     fmt::format("gave point {} of a plan at {:g} s; times must begin at 0 and grow", i + 1,
                                 plan.points[i].t_s));
    }
    return plan;
  }
  bool concerns(const ObstaclePoint& point, const Plan& plan) const override {
    return callee_.call("concerns()", [&] { return planner_->concerns(point, plan); });
  }

 private:
  std::unique_ptr<Planner> planner_;
  Callee callee_;
};

template <typename Checked, typename One, typename Context, typename... More>
auto checked_by(const char* kind, const One& part, const Context& context, const More&... more)
    -> decltype(part.make(context)) {
  if (part.plugin.empty()) return part.make(context);
  const Callee callee(kind, part);
  auto made = callee.call("make()", [&] { return part.make(context); });
  if (made == nullptr) callee.fail("make()", "gave nothing");
  return std::make_unique<Checked>(std::move(made), part, more...);
}

}  // namespace

std::unique_ptr<ObstacleDetector> checked(const DetectorPart& part, const FlightContext& context) {
  return checked_by<CheckedDetector>("detector", part, context, context.rig.rig);
}

std::unique_ptr<StateSource> checked(const StateSourcePart& part, const FlightContext& context) {
  return checked_by<CheckedStateSource>("state source", part, context);
}

std::unique_ptr<Planner> checked(const PlannerPart& part, const PlannerPartContext& context) {
  return checked_by<CheckedPlanner>("planner", part, context);
}

Planted checked(const CoursePart& part, const CourseContext& context) {
  if (part.plugin.empty()) return part.make(context);
  const Callee callee("course", part);
  Planted planted = callee.call("make()", [&] { return part.make(context); });
  if (planted.obstacles.size() > maximum_obstacles)
    callee.fail("make()", fmt::format("gave {} obstacles, at most {} are possible", planted.obstacles.size(),
                                      maximum_obstacles));
  for (std::size_t i = 0; i < planted.obstacles.size(); ++i) {
    const Obstacle& one = planted.obstacles[i];
    const bool has_radius = one.kind != ObstacleKind::wall && one.kind != ObstacleKind::box;
    const bool has_length = one.kind == ObstacleKind::sphere || one.to_world != one.from_world;
    constexpr double farthest_m = 10'000, widest_m = 400;  // false for what is not a number
    const bool is_near = one.from_world.cwiseAbs().maxCoeff() <= farthest_m &&
                         one.to_world.cwiseAbs().maxCoeff() <= farthest_m;
    const bool is_small =
        one.radius_m >= 0 && one.radius_m <= widest_m && one.half_size_m.cwiseAbs().maxCoeff() <= widest_m;
    if (!is_near || !is_small || !has_length || (has_radius && one.radius_m <= 0))
      callee.fail("make()",
                  fmt::format("gave obstacle {}, which has no size, is larger than {} m or lies farther "
                              "than {} m from the launch",
                              i + 1, widest_m, farthest_m));
  }
  return planted;
}

}  // namespace understory
