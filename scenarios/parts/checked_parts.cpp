#include "scenarios/parts/checked_parts.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <list>
#include <mutex>
#include <thread>
#include <utility>

#include "perception/io/text_file.hpp"

namespace understory {
namespace {

constexpr std::chrono::milliseconds between_looks{500};
constexpr int longest_call_looks = 40;  // 20 s
constexpr double largest = 1e7;         ///< of any coordinate, speed or angle in SI units
constexpr const char* not_sound = "which is not finite, or beyond 1e7";

[[noreturn]] void end_process(const std::string& line) {
  fmt::print(stderr, "understory: {}\n", line);
  std::fflush(nullptr);
  std::_Exit(3);
}

thread_local const std::string* called = nullptr;  ///< the part's function that this thread is in; innermost

void refuse_to_end() {
  if (called != nullptr) end_process(*called + ": ended the process");
}

/// Ends the process when a call does not return, on whichever thread it is and whatever calls it makes
/// itself. Time is counted in looks, not by a clock: a process that is stopped looks at nothing. No simulated
/// time passes meanwhile, so no flight is lost by it.
class Watchdog {
 public:
  struct Call {
    std::string what;
    int looks = 0;
  };
  /// One for a process: a fork has no thread of its parent's.
  static Watchdog& instance() {
    static std::atomic<Watchdog*> watchdog = nullptr;
    if (watchdog == nullptr || watchdog.load()->process_ != getpid())
      watchdog = new Watchdog;  // its thread outlives all statics
    return *watchdog;
  }
  std::list<Call>::iterator begin(std::string what) {
    const std::lock_guard lock(mutex_);
    return calls_.insert(calls_.end(), Call{std::move(what)});
  }
  void end(std::list<Call>::iterator call) {
    const std::lock_guard lock(mutex_);
    calls_.erase(call);
  }

 private:
  Watchdog() {
    std::atexit(refuse_to_end);
    std::at_quick_exit(refuse_to_end);
    std::thread([this] {
      for (;;) {
        std::this_thread::sleep_for(between_looks);
        const std::lock_guard lock(mutex_);
        for (Call& call : calls_)
          if (++call.looks > longest_call_looks)
            end_process(fmt::format("{}: has not returned for {} s", call.what,
                                    longest_call_looks * between_looks.count() / 1000));
      }
    }).detach();
  }
  const pid_t process_ = getpid();
  std::mutex mutex_;
  std::list<Call> calls_;
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
  decltype(auto) call(const char* function_name, Function&& function) const {
    struct Watched {
      explicit Watched(std::string what)
          : dog(Watchdog::instance()),
            call(dog.begin(std::move(what))),
            outer(std::exchange(called, &call->what)) {}
      ~Watched() {
        called = outer;
        dog.end(call);
      }
      Watchdog& dog;
      std::list<Watchdog::Call>::iterator call;
      const std::string* outer;
    } watched(name + function_name);
    try {
      return function();
    } catch (const InputError&) {
      throw;  // what a person gave it, in its own words
    } catch (const MachineError&) {
      throw;
    } catch (const std::exception& error) {
      fail(function_name, fmt::format("threw: {}", error.what()));
    } catch (...) {
      fail(function_name, "threw what is no std::exception");
    }
  }
};

bool is_sound(const auto& numbers) { return (numbers.array().abs() <= largest).all(); }
bool is_sound(double number) { return std::abs(number) <= largest; }

bool is_pose(const Eigen::Isometry3d& pose) {
  constexpr double off = 1e-3;
  const Eigen::Matrix3d turn = pose.linear();
  return ((turn.transpose() * turn - Eigen::Matrix3d::Identity()).array().abs() < off).all() &&
         turn.determinant() > 0 && pose.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
}

class CheckedDetector : public ObstacleDetector {
 public:
  CheckedDetector(std::unique_ptr<ObstacleDetector> detector, const DetectorPart& part, const StereoRig& rig)
      : detector_(std::move(detector)), callee_("detector", part), rig_(rig) {}

  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    const std::vector<StereoHit>& hits =
        callee_.call("detect()", [&]() -> const std::vector<StereoHit>& { return detector_->detect(frame); });
    if (hits.size() > static_cast<std::size_t>(rig_.width_px) * rig_.height_px)
      callee_.fail("detect()", fmt::format("gave {} hits, more than the image has pixels", hits.size()));
    int row_px = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const StereoHit& hit = hits[i];
      const auto fail = [&](const std::string& why) {
        callee_.fail("detect()", fmt::format("gave hit {} of {}, {}", i + 1, hits.size(), why));
      };
      if (!is_sound(hit.position_camera) || !is_sound(hit.disparity_px)) fail(not_sound);
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
    if (!is_sound(state.T_world_body.translation()) || !is_sound(state.velocity_body_mps) ||
        !is_sound(state.angular_rate_body_radps) || !is_sound(state.specific_force_body_mps2) ||
        !is_sound(state.wind_world_mps) || !is_sound(state.gust_world_mps) || !is_sound(state.altitude_m) ||
        !is_sound(state.distance_flown_m))
      callee_.fail(call, fmt::format("gave a state {}", not_sound));
    if (!is_pose(state.T_world_body))
      callee_.fail(call,
                   "gave a T_world_body that is no pose: a rotation matrix, the position, and 0 0 0 1 below");
  }
  std::unique_ptr<StateSource> source_;
  Callee callee_;
  std::int64_t newest_ns_ = 0;
};

bool is_sound(const PlanPoint& point) {
  return is_sound(point.position_world) &&
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
      if (!is_sound(plan.points[i]))
        callee_.fail("plan()", fmt::format("gave point {} of a plan, {}", i + 1, not_sound));
      if (i == 0 ? plan.points[i].t_s != 0 : plan.points[i].t_s <= plan.points[i - 1].t_s)
        callee_.fail("plan()",
                     fmt::format("gave point {} of a plan at {:g} s; times must begin at 0 and grow", i + 1,
                                 plan.points[i].t_s));
    }
    return plan;
  }
  void change(const PlannerConfig& config, std::uint64_t seed) override {
    callee_.call("change()", [&] { planner_->change(config, seed); });
  }
  bool concerns(const ObstaclePoint& point, const Plan& plan) const override {
    return callee_.call("concerns()", [&] { return planner_->concerns(point, plan); });
  }

 private:
  std::unique_ptr<Planner> planner_;
  Callee callee_;
};

constexpr double farthest_m = 10'000, widest_m = 400, thinnest_m = 0.001;

bool is_sound(const Obstacle& one) {
  const auto within = [](const auto& numbers, double least, double most) {
    return (numbers.array() >= least && numbers.array() <= most).all();  // false for what is not a number
  };
  const bool is_wall = one.kind == ObstacleKind::wall, is_box = one.kind == ObstacleKind::box;
  const bool has_length = one.kind == ObstacleKind::sphere || one.to_world != one.from_world;
  return within(one.from_world, -farthest_m, farthest_m) && within(one.to_world, -farthest_m, farthest_m) &&
         has_length && one.radius_m >= (is_wall ? 0 : thinnest_m) && one.radius_m <= widest_m &&
         (!is_box || within(one.half_size_m, thinnest_m, widest_m));
}

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
    if (!is_sound(planted.obstacles[i]))
      callee.fail("make()",
                  fmt::format("gave obstacle {}, which is not finite, has no length, is thinner than {} m or "
                              "larger than {} m, or lies farther than {} m from the launch",
                              i + 1, thinnest_m, widest_m, farthest_m));
  }
  return planted;
}

}  // namespace understory
