// Parts with one defect each, which `understory plugin --check` must find.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <variant>

#include <opencv2/core.hpp>

#include "scenarios/scenario/plugin.hpp"

namespace {

using namespace understory;

StereoHit hit_at(int column, int row) {
  StereoHit hit;
  hit.position_camera = {0, 0, 10};
  hit.column_px = column, hit.row_px = row;
  hit.disparity_px = 10;
  return hit;
}

/// Calls a function on each frame.
class FunctionDetector : public ObstacleDetector {
 public:
  using Function = std::function<void(const StereoFrame&, std::vector<StereoHit>&)>;
  explicit FunctionDetector(Function function) : function_(std::move(function)) {}
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    hits_.clear();
    function_(frame, hits_);
    return hits_;
  }

 private:
  Function function_;
  std::vector<StereoHit> hits_;
};

void add_detector(Parts& parts, const std::string& name,
                  std::function<FunctionDetector::Function()> function) {
  parts.detectors.add({.name = name, .meaning = "has a defect", .make = [function](const FlightContext&) {
                         return std::make_unique<FunctionDetector>(function());
                       }});
}

bool is_black(const StereoFrame& frame) {
  return frame.left.at<unsigned char>(10, 10) == 0 && cv::countNonZero(frame.left) == 0;
}

class FunctionPlanner : public Planner {
 public:
  using Function = std::function<Plan(const PlanRequest&)>;
  explicit FunctionPlanner(Function function) : function_(std::move(function)) {}
  Plan plan(const PlanRequest& request) override { return function_(request); }

 private:
  Function function_;
};

Plan level_plan(const PlanRequest& request) {
  Plan plan;
  plan.t_ns = request.t_ns;
  for (int i = 0; i < 60; ++i) {
    PlanPoint point;
    point.t_s = 0.02 * i;
    point.position_world = request.start.position_world + Eigen::Vector3d(0.24 * i, 0, 0);
    point.speed_mps = 12;
    plan.points.push_back(point);
  }
  return plan;
}

void add_planner(Parts& parts, const std::string& name, FunctionPlanner::Function function) {
  parts.planners.add({.name = name, .meaning = "has a defect", .make = [function](const PlannerPartContext&) {
                        return std::make_unique<FunctionPlanner>(function);
                      }});
}

/// Its rotation is none.
class PoselessSource : public StateSource {
 public:
  PoselessSource() { state_.T_world_body.linear().setZero(); }
  void on(const Sample& sample) override {
    if (const auto* imu = std::get_if<ImuSample>(&sample)) state_.t_ns = imu->t_ns;
  }
  const State& state() const override { return state_; }
  State state_at(std::int64_t) const override { return state_; }

 private:
  State state_;
};

class StuckSource : public StateSource {
 public:
  void on(const Sample& sample) override {
    if (const auto* imu = std::get_if<ImuSample>(&sample))
      state_.t_ns = imu->t_ns > 300'000'000 ? 1 : imu->t_ns;
  }
  const State& state() const override { return state_; }
  State state_at(std::int64_t) const override { return state_; }

 private:
  State state_;
};

void add_detectors_with_wrong_hits(Parts& parts) {
  add_detector(parts, "unequal", [] {
    return [](const StereoFrame&, std::vector<StereoHit>& hits) {
      static int calls = 0;
      hits.push_back(hit_at(++calls % 100, 20));
    };
  });
  add_detector(parts, "disturbed", [] {
    // Equal on its own, as each instance begins anew: the newest instance resets what all of them share.
    static int shared = 0;
    shared = 0;
    return [](const StereoFrame& frame, std::vector<StereoHit>& hits) {
      if (!is_black(frame)) hits.push_back(hit_at(++shared % 100, 20));
    };
  });
  add_detector(parts, "not_finite", [] {
    return [](const StereoFrame&, std::vector<StereoHit>& hits) {
      hits.push_back(hit_at(20, 20));
      hits.back().position_camera.x() = std::nan("");
    };
  });
  add_detector(parts, "outside", [] {
    return [](const StereoFrame& frame, std::vector<StereoHit>& hits) {
      hits.push_back(hit_at(frame.left.cols, 20));
    };
  });
  add_detector(parts, "unordered", [] {
    return [](const StereoFrame&, std::vector<StereoHit>& hits) { hits = {hit_at(20, 50), hit_at(20, 20)}; };
  });
}

void add_other_detectors(Parts& parts) {
  add_detector(parts, "sees_in_the_dark", [] {
    return [](const StereoFrame&, std::vector<StereoHit>& hits) { hits.push_back(hit_at(20, 20)); };
  });
  add_detector(parts, "wants_later_times", [] {
    return [last = std::int64_t{-1}](const StereoFrame& frame, std::vector<StereoHit>&) mutable {
      if (frame.t_ns <= last) throw std::runtime_error("the time did not grow");
      last = frame.t_ns;
    };
  });
  parts.detectors.add({.name = "slow", .meaning = "has a defect", .make = [](const FlightContext& context) {
                         const std::shared_ptr<ObstacleDetector> ours =
                             understory::parts().detectors.find("stereo_sgbm")->make(context);
                         return std::make_unique<FunctionDetector>(
                             [ours](const StereoFrame& frame, std::vector<StereoHit>& hits) {
                               for (int i = 0; i < 5; ++i) hits = ours->detect(frame);
                             });
                       }});
  add_detector(parts, "leaky", [] {
    return [](const StereoFrame&, std::vector<StereoHit>&) {
      static std::vector<double>* newest = nullptr;
      newest = new std::vector<double>(50, newest == nullptr ? 1.0 : newest->front());
    };
  });
  add_detector(parts, "throws", [] {
    return [](const StereoFrame&, std::vector<StereoHit>&) { throw std::logic_error("this must not be"); };
  });
}

void add_others(Parts& parts) {
  add_planner(parts, "into_the_past", [](const PlanRequest& request) {
    Plan plan = level_plan(request);
    plan.t_ns -= 1'000'000;
    return plan;
  });
  add_planner(parts, "wants_points", [](const PlanRequest& request) {
    Plan plan = level_plan(request);
    plan.points.front().bank_rad =
        request.points.at(0).position_world.x() - request.points.at(0).position_world.x();
    return plan;
  });
  add_planner(parts, "no_plan", [](const PlanRequest& request) {
    Plan plan;
    plan.t_ns = request.t_ns;
    return plan;
  });
  parts.state_sources.add({.name = "back_in_time",
                           .meaning = "has a defect",
                           .make = [](const FlightContext&) { return std::make_unique<StuckSource>(); }});
  parts.courses.add(
      {.name = "another_each_time", .meaning = "has a defect", .make = [](const CourseContext&) {
         static int calls = 0;
         Obstacle pole{.name = "pole"};
         pole.from_world = {30, 5.0 + 0.01 * ++calls, 0};
         pole.to_world = pole.from_world + Eigen::Vector3d(0, 0, 9);
         return Planted{{pole}};
       }});
  parts.courses.add({.name = "nowhere", .meaning = "has a defect", .make = [](const CourseContext&) {
                       Obstacle pole{.name = "pole"};
                       pole.from_world = {std::nan(""), 0, 0};
                       return Planted{{pole}};
                     }});
  parts.courses.add({.name = "sideways_nowhere", .meaning = "has a defect", .make = [](const CourseContext&) {
                       Obstacle pole{.name = "pole"};
                       pole.from_world = {30, std::nan(""), 0};
                       pole.to_world = {30, 0, 9};
                       return Planted{{pole}};
                     }});
  parts.courses.add({.name = "huge", .meaning = "has a defect", .make = [](const CourseContext&) {
                       Obstacle pole{.name = "pole"};
                       pole.from_world = {30, 5, 0};
                       pole.to_world = {30, 5, 9};
                       pole.radius_m = 1e9;
                       return Planted{{pole}};
                     }});
  parts.state_sources.add({.name = "no_pose", .meaning = "has a defect", .make = [](const FlightContext&) {
                             return std::make_unique<PoselessSource>();
                           }});
}

void add_blocking(Parts& parts) {
  add_detector(parts, "blocks", [] {
    return [](const StereoFrame&, std::vector<StereoHit>&) {
      std::this_thread::sleep_for(std::chrono::hours(1));
    };
  });
  add_detector(parts, "exits",
               [] { return [](const StereoFrame&, std::vector<StereoHit>&) { std::exit(0); }; });
}

}  // namespace

UNDERSTORY_PLUGIN(parts) {
#ifdef BLOCKING
  add_blocking(parts);
#else
  add_detectors_with_wrong_hits(parts);
  add_other_detectors(parts);
  add_others(parts);
#endif
}
