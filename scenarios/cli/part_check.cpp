#include "scenarios/cli/part_check.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>

#include "scenarios/bench/bench.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/parts/checked_parts.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

#ifdef __SANITIZE_ADDRESS__
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();  // GCC 12 has no header for it
#endif

namespace understory {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int usual_inputs = 24;
constexpr double slowest_ratio = 3;        ///< of a call's time to that of our StereoSGBM in the same run
constexpr double memory_calls = 150;       ///< of StereoSGBM; of a faster part as many more as take this time
constexpr double most_growth_bytes = 3e5;  ///< of the heap, over the last nine tenths of the calls

/// An input beside the usual ones.
enum class Odd { no, empty, repeated };

/// A part under test: takes an input of a stream and gives its output as bytes.
class Subject {
 public:
  virtual ~Subject() = default;
  virtual std::string step(int input, int stream, Odd odd) = 0;
};

/// A part of any kind, as the checks see it.
struct PartTrial {
  std::string kind = "", name = "", plugin = "";
  std::function<std::unique_ptr<Subject>()> make = nullptr;
  std::string empty_input = "";  ///< "a black image"; empty: there is none
  std::string settings = "";     ///< of the flights that test it, a YAML scenario
  bool has_times = true;         ///< whether inputs bear times
};

template <typename Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
void append(std::string& bytes, const Eigen::Vector3d& value) {
  for (const double number : value) append(bytes, number);
}

/// A flight that parts are made for, and truth for its oracles.
struct Stage {
  Stage(const std::string& yaml, const std::filesystem::path& models)
      : scenario(scenario_from_text(yaml, "check")),
        rig(rig_of(scenario, models)),
        obstacles(course_obstacles(scenario)) {}

  FlightContext context() const { return {scenario, rig, obstacles, history, 7}; }
  Scenario scenario;
  CalibratedRig rig;
  std::vector<Obstacle> obstacles;
  TruthHistory history;
};

class DetectorSubject : public Subject {
 public:
  DetectorSubject(const DetectorPart& part, const std::string& yaml, const std::filesystem::path& models,
                  const std::vector<StereoFrame>& frames)
      : stage_(yaml, models), frames_(frames) {
    stage_.history.observe(Truth{});
    detector_ = checked(part, stage_.context());
  }
  std::string step(int input, int stream, Odd odd) override {
    StereoFrame frame = frames_[static_cast<std::size_t>(input * (stream + 1)) % frames_.size()];
    if (odd == Odd::empty) {
      frame.left = cv::Mat::zeros(frame.left.size(), CV_8UC1);
      frame.right = frame.left;
    }
    if (odd != Odd::repeated) t_ns_ += 8'333'333;
    frame.t_ns = t_ns_;
    Truth truth;
    truth.t_ns = t_ns_;
    truth.T_world_body.translation() = Eigen::Vector3d(0.1 * (input + stream), 0, 4);
    if (odd != Odd::repeated) stage_.history.observe(truth);
    std::string bytes;
    for (const StereoHit& hit : detector_->detect(frame)) {
      append(bytes, hit.position_camera);
      append(bytes, hit.column_px), append(bytes, hit.row_px), append(bytes, hit.disparity_px);
    }
    if (odd == Odd::empty && !bytes.empty()) throw MachineError("detect() gave hits in a black image");
    return bytes;
  }

 private:
  Stage stage_;
  const std::vector<StereoFrame>& frames_;
  std::unique_ptr<ObstacleDetector> detector_;
  std::int64_t t_ns_ = 0;
};

class StateSourceSubject : public Subject {
 public:
  StateSourceSubject(const StateSourcePart& part, const std::string& yaml,
                     const std::filesystem::path& models)
      : stage_(yaml, models) {
    stage_.history.observe(Truth{});
    source_ = checked(part, stage_.context());
  }
  /// Ten IMU samples with what else arrives: at rest, along the rail, level.
  std::string step(int input, int stream, Odd odd) override {
    for (int i = 0; i < 10; ++i) {
      if (odd != Odd::repeated) t_ns_ += 5'000'000;
      const bool on_rail = count_ >= 40 && count_ < 80;
      const double wave = std::sin(0.1 * count_ + stream);
      if (odd != Odd::repeated) ++count_;
      Truth truth;
      truth.t_ns = t_ns_;
      if (odd != Odd::repeated) stage_.history.observe(truth);
      source_->on(ImuSample{t_ns_, {0.1 * wave, 0, 0}, {on_rail ? 45.0 : 0.5 * wave, 0, 9.81}});
      if (i == 3) source_->on(PitotSample{t_ns_, count_ < 80 ? 0.2 * count_ : 12 + 0.1 * wave});
      if (i == 5) source_->on(BarometerSample{t_ns_, 2 + 0.01 * input});
    }
    std::string bytes;
    for (const State& state : {source_->state(), source_->state_at(t_ns_ - 30'000'000)}) {
      append(bytes, state.t_ns);
      append(bytes, Eigen::Vector3d(state.T_world_body.translation()));
      append(bytes, state.velocity_body_mps), append(bytes, state.angular_rate_body_radps);
    }
    return bytes;
  }

 private:
  Stage stage_;
  std::unique_ptr<StateSource> source_;
  std::int64_t t_ns_ = 0;
  int count_ = 0;
};

class PlannerSubject : public Subject {
 public:
  PlannerSubject(const PlannerPart& part, const std::string& yaml)
      : scenario_(scenario_from_text(yaml, "check")),
        model_(scenario_.airframe, scenario_.autopilot.flight_model),
        mission_(scenario_.mission()) {
    const PlannerContext context{scenario_.autopilot.planner, model_, mission_, 7};
    planner_ = checked(part, PlannerPartContext{context, scenario_});
  }
  std::string step(int input, int stream, Odd odd) override {
    if (odd != Odd::repeated) t_ns_ += 40'000'000;
    PlanRequest request;
    request.start.position_world = {0.4 * input, 0.2 * stream, 4};
    request.t_ns = t_ns_;
    request.distance_flown_m = 0.4 * input;
    std::mt19937_64 generator(static_cast<std::uint64_t>(100 * stream + input / 6));
    std::uniform_real_distribution<double> ahead(4, 14), aside(-4, 4);
    for (int trunk = 0; odd != Odd::empty && trunk < 6; ++trunk) {
      const double x_m = request.start.position_world.x() + ahead(generator), y_m = aside(generator);
      for (double z_m = 1; z_m < 6; z_m += 0.5) request.points.push_back({{x_m, y_m, z_m}, t_ns_});
    }
    const Plan plan = planner_->plan(request);
    if (!request.points.empty()) planner_->concerns(request.points.front(), plan);
    std::string bytes;
    append(bytes, plan.origin);
    for (const PlanPoint& point : plan.points)
      append(bytes, point.position_world), append(bytes, point.bank_command_rad),
          append(bytes, point.climb_command_mps);
    return bytes;
  }

 private:
  Scenario scenario_;
  FlightModel model_;
  Mission mission_;
  std::unique_ptr<Planner> planner_;
  std::int64_t t_ns_ = 1'000'000'000;
};

/// A course is a function of the seed: a step is a seed.
class CourseSubject : public Subject {
 public:
  CourseSubject(const CoursePart& part, const std::string& yaml)
      : part_(part), scenario_(scenario_from_text(yaml, "check")) {}
  std::string step(int input, int stream, Odd) override {
    scenario_.seed = static_cast<std::uint64_t>(1 + input + 100 * stream);
    const Planted planted = checked(part_, {scenario_, scenario_.seed});
    std::string bytes;
    for (const Obstacle& one : planted.obstacles)
      append(bytes, one.from_world), append(bytes, one.to_world), append(bytes, one.radius_m);
    return bytes;
  }

 private:
  const CoursePart& part_;
  Scenario scenario_;
};

std::string outputs_of(Subject& subject, int stream) {
  std::string bytes;
  for (int input = 0; input < usual_inputs; ++input) bytes += subject.step(input, stream, Odd::no);
  return bytes;
}

std::string is_repeatable(const PartTrial& trial) {
  return outputs_of(*trial.make(), 0) == outputs_of(*trial.make(), 0)
             ? ""
             : "two instances gave different outputs for the same inputs";
}

/// A second instance is fed other inputs by turns.
std::string is_undisturbed(const PartTrial& trial) {
  const std::string alone = outputs_of(*trial.make(), 0);
  const auto first = trial.make(), second = trial.make();
  std::string beside;
  for (int input = 0; input < usual_inputs; ++input) {
    beside += first->step(input, 0, Odd::no);
    second->step(input, 1, Odd::no);
  }
  return alone == beside ? "" : "its outputs changed because another instance was used beside it";
}

std::string takes_odd_input(const PartTrial& trial, Odd odd) {
  const auto subject = trial.make();
  subject->step(0, 0, odd == Odd::empty ? odd : Odd::no);
  subject->step(1, 0, Odd::no);
  subject->step(1, 0, odd);
  subject->step(2, 0, Odd::no);
  return "";
}

double elapsed_s(Clock::time_point since) {
  return std::chrono::duration<double>(Clock::now() - since).count();
}

struct CallTimes {
  double median_s, p99_s;
  double yardstick_s;  ///< median of the yardstick's
};

/// By turns with the yardstick: what else the machine does slows both alike.
CallTimes times_of(const PartTrial& trial, const PartTrial& yardstick) {
  std::vector<double> times_s, yardsticks_s;
  const auto subject = trial.make(), other = yardstick.make();
  const Clock::time_point begin = Clock::now();
  for (int input = 0; times_s.size() < 20 || (times_s.size() < 400 && elapsed_s(begin) < 0.5); ++input)
    for (const auto& [one, times] : {std::pair(&subject, &times_s), std::pair(&other, &yardsticks_s)}) {
      const Clock::time_point call = Clock::now();
      (*one)->step(input % usual_inputs, 0, Odd::no);
      times->push_back(elapsed_s(call));
    }
  std::ranges::sort(times_s);
  std::ranges::sort(yardsticks_s);
  return {times_s[times_s.size() / 2], times_s[times_s.size() * 99 / 100],
          yardsticks_s[yardsticks_s.size() / 2]};
}

double heap_bytes() {
#ifdef __SANITIZE_ADDRESS__  // its heap is not glibc's
  return static_cast<double>(__sanitizer_get_current_allocated_bytes());
#else
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
#endif
}

std::string keeps_memory(const PartTrial& trial, int calls, std::string& note) {
  const auto subject = trial.make();
  double settled = 0;
  for (int call = 0; call < calls; ++call) {
    if (call == calls / 10) settled = heap_bytes();
    subject->step(call % usual_inputs, 0, Odd::no);
  }
  const double growth = heap_bytes() - settled;
  note = fmt::format("{} calls, {:+.1f} kB", calls, 1e-3 * growth);
  return growth > most_growth_bytes
             ? fmt::format("the heap grew by {:.0f} bytes a call", growth / (calls - calls / 10))
             : "";
}

std::string flies_twice_alike(const PartTrial& trial, const std::filesystem::path& models,
                              std::string& note) {
  const Scenario scenario = scenario_from_text(trial.settings, "check");
  FlyOptions options;
  options.models_folder = models;
  const FlightResult first = fly(scenario, options), second = fly(scenario, options);
  note = fmt::format("digest {}, {}", first.digest, word_for(first.outcome));
  return first.digest == second.digest ? "" : "two flights of one seed have different digests";
}

/// All parts that came from `plugin`.
std::vector<PartTrial> trials_of(const std::string& plugin, const std::filesystem::path& models,
                                 const std::vector<StereoFrame>& frames) {
  std::vector<PartTrial> trials;
  const auto each = [&](const auto& list, const char* kind, auto&& trial_of) {
    for (const auto& part : list.all())
      if (part.plugin == plugin) {
        PartTrial trial = trial_of(part);
        trial.kind = kind, trial.name = part.name, trial.plugin = part.plugin;
        trials.push_back(std::move(trial));
      }
  };
  constexpr const char* with = "forest: {{length_m: 15}}\n{}";
  each(parts().detectors, "detector", [&](const DetectorPart& part) {
    const std::string yaml = fmt::format(with, "perception: {detector: " + part.name + "}\n");
    return PartTrial{
        .make = [&part, yaml, &models,
                 &frames] { return std::make_unique<DetectorSubject>(part, yaml, models, frames); },
        .empty_input = part.needs_images ? "a black image" : "",
        .settings = yaml};
  });
  each(parts().state_sources, "state source", [&](const StateSourcePart& part) {
    const std::string own = "estimation: {source: " + part.name + "}\n";
    const std::string yaml = fmt::format(with, own + "perception: {detector: true_depth}\n");
    return PartTrial{
        .make = [&part, yaml, &models] { return std::make_unique<StateSourceSubject>(part, yaml, models); },
        .settings = yaml};
  });
  each(parts().planners, "planner", [&](const PlannerPart& part) {
    const std::string own = "autopilot: {method: " + part.name + "}\n";
    const std::string yaml = fmt::format(with, own + "perception: {detector: true_depth}\n");
    return PartTrial{.make = [&part, yaml] { return std::make_unique<PlannerSubject>(part, yaml); },
                     .empty_input = "an empty map",
                     .settings = yaml};
  });
  each(parts().courses, "course", [&](const CoursePart& part) {
    const std::string own = "course: " + part.name + "\n";
    const std::string yaml = fmt::format(with, own + "perception: {detector: true_depth}\n");
    return PartTrial{.make = [&part, yaml] { return std::make_unique<CourseSubject>(part, yaml); },
                     .settings = yaml,
                     .has_times = false};
  });
  return trials;
}

/// Our part of the kind, which others' times are shown beside.
const char* yardstick_of(const std::string& kind) {
  if (kind == "detector") return "pushbroom";
  if (kind == "state source") return "filter";
  return kind == "planner" ? "sst" : "forest";
}

}  // namespace

std::vector<PartCheck> check_parts(const PartCheckOptions& options) {
  const CalibratedRig rig = rig_of(scenario_from_text("{}", "check"), options.models_folder);
  const std::vector<StereoFrame> frames = stereo_scenes(rig, 12, 3);
  const std::vector<PartTrial> ours = trials_of("", options.models_folder, frames);
  const PartTrial& sgbm = *std::ranges::find(ours, "stereo_sgbm", &PartTrial::name);
  std::vector<PartCheck> checks;
  for (const PartTrial& trial : trials_of(options.plugin, options.models_folder, frames)) {
    const auto check = [&](const std::string& what, auto&& test) {
      PartCheck one{fmt::format("{} '{}'", trial.kind, trial.name), what, "", ""};
      options.on_progress(one.part + ": " + what);
      try {
        one.fault = test(one.note);
      } catch (const std::exception& error) {
        one.fault = error.what();
      }
      checks.push_back(std::move(one));
    };
    check("outputs are finite, in bounds and in order", [&](std::string& note) {
      const std::string bytes = outputs_of(*trial.make(), 0);
      note = fmt::format("{} inputs, {} bytes of output", usual_inputs, bytes.size());
      return "";
    });
    check("equal inputs give equal outputs", [&](std::string&) { return is_repeatable(trial); });
    check("a second instance does not disturb the first",
          [&](std::string&) { return is_undisturbed(trial); });
    if (!trial.empty_input.empty())
      check("takes " + trial.empty_input, [&](std::string&) { return takes_odd_input(trial, Odd::empty); });
    if (trial.has_times)
      check("takes a repeated time stamp",
            [&](std::string&) { return takes_odd_input(trial, Odd::repeated); });
    double ratio = 0;
    check("time of a call", [&](std::string& note) {
      const CallTimes times = times_of(trial, sgbm);
      ratio = times.median_s / times.yardstick_s;
      note = fmt::format("median {:.3f} ms, 99 % {:.3f} ms", 1e3 * times.median_s, 1e3 * times.p99_s);
      const auto yardstick = std::ranges::find_if(ours, [&](const PartTrial& other) {
        return other.kind == trial.kind && other.name == yardstick_of(trial.kind);
      });
      if (!trial.plugin.empty())
        note +=
            fmt::format("; {}: median {:.3f} ms", yardstick->name, 1e3 * times_of(*yardstick, sgbm).median_s);
      return ratio > slowest_ratio ? fmt::format("{}: more than {:g} times StereoSGBM's {:.1f} ms", note,
                                                 slowest_ratio, 1e3 * times.yardstick_s)
                                   : "";
    });
    if (ratio > slowest_ratio) continue;  // the rest would take minutes
    const int calls = static_cast<int>(std::clamp<double>(
        memory_calls / std::max(ratio, 1e-6), 2 * usual_inputs, std::max(2 * usual_inputs, options.calls)));
    check("memory does not grow", [&](std::string& note) { return keeps_memory(trial, calls, note); });
    check("a flight repeats",
          [&](std::string& note) { return flies_twice_alike(trial, options.models_folder, note); });
  }
  return checks;
}

}  // namespace understory
