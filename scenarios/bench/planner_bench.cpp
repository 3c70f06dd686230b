#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <ranges>

#include "perception/io/text_table.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

/// What a planner was asked during one flight, one request after the other.
using AskedInAFlight = std::vector<PlanRequest>;

/// Reads a line's cells one after the other.
struct Cells {
  const TableLine& line;
  const std::string& name;
  std::size_t next = 1;

  double number() {
    const auto value = next < line.cells.size() ? number_in<double>(line.cells[next++]) : std::nullopt;
    if (!value)
      throw ScenarioError(fmt::format("{}:{}: not a line of problems for planners", name, line.number));
    return *value;
  }
  double metres() { return 1e-3 * number(); }
};

/// "12-15 20": points 12 to 15 and 20 of `known`, so much higher.
std::vector<ObstaclePoint> points_of(Cells& cells, const std::vector<ObstaclePoint>& known, double lift_m) {
  std::vector<ObstaclePoint> points;
  if (cells.next == cells.line.cells.size()) return points;
  for (const auto run : std::views::split(cells.line.cells[cells.next++], ' ')) {
    const std::string_view text(run.begin(), run.end());
    const std::size_t dash = text.find('-');
    const auto first = number_in<std::size_t>(text.substr(0, dash)),
               last = dash == std::string_view::npos ? first : number_in<std::size_t>(text.substr(dash + 1));
    if (!first || !last || *last >= known.size())
      throw ScenarioError(
          fmt::format("{}:{}: {} are no points of this flight", cells.name, cells.line.number, text));
    for (std::size_t i = *first; i <= *last; ++i) {
      points.push_back(known[i]);
      points.back().position_world.z() += lift_m;
    }
  }
  return points;
}

std::vector<AskedInAFlight> problems_in(const std::string& text, const std::string& name) {
  std::vector<AskedInAFlight> flights;
  std::vector<ObstaclePoint> known;
  for (const TableLine& line : table_lines(text, CellsParted::by_commas, name)) {
    Cells cells{line, name};
    if (line.cells[0] == "flight") {
      flights.emplace_back();
      known.clear();
    } else if (line.cells[0] == "point") {
      ObstaclePoint& point = known.emplace_back();
      for (int axis : {0, 1}) point.position_world[axis] = cells.metres();
      point.distance_flown_m = cells.metres();
      point.position_world.z() = cells.metres();
    } else if (line.cells[0] == "plan" && !flights.empty()) {
      PlanRequest& asked = flights.back().emplace_back();
      asked.t_ns = static_cast<std::int64_t>(cells.number());
      asked.outdated = cells.number() != 0;
      asked.distance_flown_m = cells.metres();
      const double lift_m = cells.metres();
      FlightState& start = asked.start;
      for (int axis : {0, 1, 2}) start.position_world[axis] = cells.metres();
      for (double* value :
           {&start.speed_mps, &start.heading_rad, &start.climb_angle_rad, &start.bank_rad,
            &start.roll_rate_radps, &start.angle_of_attack_rad, &start.sideslip_rad, &start.yaw_rate_radps})
        *value = cells.number();
      asked.points = points_of(cells, known, lift_m);
    } else {
      throw ScenarioError(fmt::format("{}:{}: expected flight, point or plan", name, line.number));
    }
  }
  return flights;
}

double timed_ms(const std::function<void()>& run) {
  const auto before = std::chrono::steady_clock::now();
  run();
  return 1e3 * seconds_since(before);
}

BenchRow row_of(const std::string& name, const std::vector<double>& times_ms) {
  return {name, 1, quantile(times_ms, 0.5), quantile(times_ms, 0.9), quantile(times_ms, 0.99), "", 0};
}

}  // namespace

std::vector<BenchRow> bench_planner(const std::vector<PlannerProblems>& all,
                                    const std::vector<StereoFrame>& rectified, int rounds,
                                    const std::function<void(int round)>& on_round) {
  cv::setNumThreads(1);
  std::vector<std::vector<AskedInAFlight>> asked;
  std::vector<std::vector<std::vector<double>>> times_ms;  // of each scenario's problems, one per round
  for (const PlannerProblems& problems : all) {
    asked.push_back(problems_in(problems.text, problems.name));
    std::size_t count = 0;
    for (const AskedInAFlight& flight : asked.back()) count += flight.size();
    times_ms.emplace_back(count);
  }
  std::vector<double> matching_ms;
  const auto matcher = cv::StereoBM::create(64, 9);
  cv::Mat disparities;
  std::size_t pair = 0;
  for (int round = 0; round < rounds; ++round) {
    on_round(round);
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::size_t number = 0;
      for (const AskedInAFlight& flight : asked[i]) {
        const std::unique_ptr<Planner> planner = planner_of(all[i].scenario);
        for (const PlanRequest& request : flight) {
          times_ms[i][number].push_back(timed_ms([&] { planner->plan(request); }));
          if (number++ % 8 != 0) continue;
          const StereoFrame& frame = rectified[pair++ % rectified.size()];
          matching_ms.push_back(timed_ms([&] { matcher->compute(frame.left, frame.right, disparities); }));
        }
      }
    }
  }
  std::vector<BenchRow> rows{row_of("OpenCV StereoBM, 64 disparities, block 9", matching_ms)};
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<double> medians_ms;
    for (const std::vector<double>& one : times_ms[i]) medians_ms.push_back(quantile(one, 0.5));
    BenchRow row =
        row_of(fmt::format("{} replans in {}", medians_ms.size(), all[i].scenario.name), medians_ms);
    row.yardstick = rows[0].name;
    row.ratio = row.median_ms / rows[0].median_ms;
    row.p99_ratio = row.p99_ms / rows[0].median_ms;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace understory
