#include <fmt/format.h>

#include <bitset>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "planning/airframe.hpp"
#include "planning/autopilot_config.hpp"
#include "scenarios/campaign/campaign_summary.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "tests/validation/flight_mechanics.hpp"
#include "tests/validation/sections.hpp"

/// The map of the aircraft: kilometres between crashes over speed and density, beside what theory says.
namespace understory {
namespace {

/// An override of scenarios/library/campaigns/limits.yaml.
struct Eyes {
  const char *name, *words;
};
constexpr std::array<Eyes, 7> all_eyes{{{"ours", "long rig, one depth of 10 m"},
                                        {"five_depths", "long rig, 12 to 8.8 m"},
                                        {"true_depth_and_state", "one depth, true depth and state"},
                                        {"paper_two_depths", "the paper's rig, 9.1 and 4.8 m"},
                                        {"paper_one_depth", "the paper's rig, 4.8 m"},
                                        {"everything_known", "everything known"},
                                        {"blind", "blind"}}};

constexpr AxisRange kilometres{0.002, 30};     // of all panels that have them
constexpr double reference_speed_mps = 12.27;  // of FlightModelConfig::maximum_roll_rate_radps
const double half_span_m = 0.5 * Airframe().span_m;
constexpr double mean_radius_m = 0.175;  // of forest.yaml
const double latency_s =                 // frame, plan and input
    Scenario().cameras.latency_s + AutopilotConfig().plan_latency_s + Airframe().input_delay_s;

/// At the planner's largest angle of attack.
SteadyFlight hardest(double speed_mps) {
  return hardest_turn(Airframe(), speed_mps, FlightModelConfig().maximum_angle_of_attack_rad);
}

double turn_radius_m(double speed_mps) { return hardest(speed_mps).radius_m(); }

/// Straight through a Poisson forest: what is struck stands within a strip as wide as span and trunk.
double blind_km(double per_tree_m2) { return 1e-3 * per_tree_m2 / (2 * (half_span_m + mean_radius_m)); }

/// Falanga, Kim & Scaramuzza 2019: from how far a trunk must be seen to be avoided by half the way aside with
/// all acceleration and half with all of it against that. `asides`: 2 for that, the square root of 2 for who
/// only misses this trunk. A wing's acceleration grows as the square of its speed: the radius says it.
double needed_sight_m(double speed_mps, double asides, bool rolls_first) {
  const SteadyFlight turn = hardest(speed_mps);
  const double roll_m = turn.bank_rad * reference_speed_mps / FlightModelConfig().maximum_roll_rate_radps;
  return speed_mps * latency_s + (rolls_first ? roll_m : 0) +
         asides * std::sqrt((half_span_m + mean_radius_m) * turn.radius_m());
}

/// How far anybody gets who knows every tree of a Poisson forest and turns in circles of `radius_m` at least,
/// up to 60 degrees from the way: the set of places and headings that can be reached, step by step.
double passable_m(double per_tree_m2, double radius_m, double length_m, std::uint64_t seed) {
  constexpr std::size_t columns = 1024;
  constexpr double column_m = 0.05, step_m = 0.25, width_m = columns * column_m,
                   steepest_rad = std::numbers::pi / 3;
  using Line = std::bitset<columns>;
  const int steps = static_cast<int>(length_m / step_m);
  const double reach_m = half_span_m + mean_radius_m;
  std::mt19937_64 generator(seed);
  std::vector<Line> free(static_cast<std::size_t>(steps), Line().set());
  const int trees = std::poisson_distribution<int>(length_m * width_m / per_tree_m2)(generator);
  for (int i = 0; i < trees; ++i) {
    const double x_m = std::uniform_real_distribution<double>(0, length_m)(generator),
                 y_m = std::uniform_real_distribution<double>(0, width_m)(generator);
    for (int step = std::max(0, static_cast<int>((x_m - reach_m) / step_m));
         step < std::min(steps, static_cast<int>((x_m + reach_m) / step_m) + 1); ++step) {
      const double along_m = step * step_m - x_m;
      if (std::abs(along_m) >= reach_m) continue;
      const double aside_m = std::sqrt(reach_m * reach_m - along_m * along_m);
      for (double y = y_m - aside_m; y < y_m + aside_m; y += column_m)
        free[static_cast<std::size_t>(step)].reset(
            static_cast<std::size_t>(std::floor((y + width_m) / column_m)) % columns);
    }
  }
  const double turn_rad = step_m / radius_m;
  const int most = static_cast<int>(steepest_rad / turn_rad);
  std::vector<Line> reached(static_cast<std::size_t>(2 * most + 1)), next = reached;
  reached[static_cast<std::size_t>(most)].set();
  for (int step = 0; step < steps; ++step) {
    bool any = false;
    for (int heading = -most; heading <= most; ++heading) {
      const auto at = static_cast<std::size_t>(heading + most);
      Line from = reached[at];
      if (heading > -most) from |= reached[at - 1];
      if (heading < most) from |= reached[at + 1];
      const double slope = step_m / column_m * std::tan(heading * turn_rad);
      const auto moved = std::lround((step + 1) * slope) - std::lround(step * slope);
      const auto by = static_cast<std::size_t>((moved % static_cast<long>(columns) + columns) % columns);
      next[at] = ((from << by) | (from >> (columns - by))) & free[static_cast<std::size_t>(step)];
      any = any || next[at].any();
    }
    if (!any) return step * step_m;
    std::swap(reached, next);
  }
  return length_m;
}

/// Square metres per tree at which half of the forests let a kilometre through (Karaman & Frazzoli 2012 prove
/// that there is such a change).
double critical_m2(double radius_m) {
  constexpr int forests = 9;
  double too_dense = 1, thin_enough = 100;
  for (int i = 0; i < 10; ++i) {
    const double middle = std::sqrt(too_dense * thin_enough);
    int passed = 0;
    for (std::uint64_t seed = 1; seed <= forests; ++seed)
      passed += passable_m(middle, radius_m, 1000, seed) >= 1000;
    (2 * passed > forests ? thin_enough : too_dense) = middle;
  }
  return thin_enough;
}

struct Cell {
  double per_tree_m2 = 0, cruise_mps = 0;
  auto operator<=>(const Cell&) const = default;
};
using Cells = std::map<Cell, std::vector<FlightRow>>;

std::map<std::string, Cells> flown_cells() {
  const std::string file = UNDERSTORY_SOURCE_DIR "/docs/results/limits/flights.csv";
  std::map<std::string, Cells> cells;
  for (const FlightRow& row : rows_from_csv(read_file(file, 1 << 24), file)) {
    const std::size_t begin = row.condition.find('-') + 1, end = row.condition.find('-', begin);
    if (!row.flown()) throw std::runtime_error(file + ": " + row.id + " is not flown");
    cells[row.condition.substr(begin, end - begin)][{row.square_metres_per_tree, row.cruise_speed_mps}]
        .push_back(row);
  }
  return cells;
}

/// Over how far the aircraft sees, the four speeds together.
LinePlot sight_panel(const std::map<std::string, Cells>& flown) {
  LinePlot panel{.title = "Sight, all speeds",
                 .x_label = "farthest depth that is looked at (m)",
                 .y_label = "km between crashes, 95 %",
                 .references = {{std::log10(needed_sight_m(12, 2, true)), "bound", true}},
                 .x_range = AxisRange{std::log10(4), std::log10(60)},
                 .y_range = kilometres,
                 .y_log = true};
  constexpr std::array<std::pair<const char*, double>, 5> sights{{{"paper_one_depth", 4.8},
                                                                  {"paper_two_depths", 9.1},
                                                                  {"ours", 10},
                                                                  {"five_depths", 12},
                                                                  {"everything_known", 40}}};
  for (const auto& [eyes, sight_m] : sights)
    panel.x_names.emplace_back(std::log10(sight_m), fmt::format("{}", sight_m));
  int colour = 0;
  for (const double per_tree_m2 : {49.0, 25.0, 16.0, 9.0}) {
    Series series{.name = fmt::format("{:.0f} m between trees", std::sqrt(per_tree_m2)),
                  .mark = Mark::line_and_dots,
                  .colour = colour++};
    for (const auto& [eyes, sight_m] : sights) {
      std::vector<FlightRow> of_all_speeds;
      for (const auto& [cell, rows] : flown.at(eyes))
        if (cell.per_tree_m2 == per_tree_m2)
          of_all_speeds.insert(of_all_speeds.end(), rows.begin(), rows.end());
      const CrashDistance distance = crash_distance(summary_of(of_all_speeds));
      series.add(std::log10(sight_m), distance.measured_km(), distance.interval.minimum,
                 distance.interval.maximum);
    }
    panel.series.push_back(series);
  }
  return panel;
}

}  // namespace

Section limits_section() {
  Section section{"limits"};
  const std::map<std::string, Cells> flown = flown_cells();
  std::vector<LinePlot> panels;
  LinePlot without_unit{.title = "Without dimension, colours as above",
                        .x_label = "trees in the square of the turning radius R",
                        .y_label = "trees in the way between crashes",
                        .x_range = AxisRange{std::log10(1.5), std::log10(120)},
                        .y_log = true};
  for (const double trees : {2.0, 5.0, 10.0, 20.0, 50.0})
    without_unit.x_names.emplace_back(std::log10(trees), fmt::format("{}", trees));
  without_unit.series.resize(all_eyes.size(), {.mark = Mark::dots});
  for (const double per_tree_m2 : {49.0, 25.0, 16.0, 9.0}) {
    LinePlot panel{
        .title = fmt::format("{:.0f} m between trees", std::sqrt(per_tree_m2)),
        .x_label = "speed flown (m/s)",
        .y_label = "km between crashes, 95 %",
        .references = {{blind_km(per_tree_m2), panels.size() < 3 ? "" : "blind, by theory", false}},
        .x_range = AxisRange{8.5, 12.5},
        .y_range = kilometres,
        .y_log = true};
    for (std::size_t i = 0; i < all_eyes.size(); ++i) {
      Series series{.name = panels.empty() ? all_eyes[i].words : "", .mark = Mark::line_and_dots};
      for (const auto& [cell, rows] : flown.at(all_eyes[i].name)) {
        if (cell.per_tree_m2 != per_tree_m2) continue;
        const ConditionSummary summary = summary_of(rows);
        const CrashDistance distance = crash_distance(summary);
        const double aside_mps = 0.04 * (static_cast<double>(i) - 3);  // bars would hide each other
        const auto add = [&](Series& to, double at, double scale) {
          to.add(at, scale * distance.measured_km(), scale * distance.interval.minimum,
                 scale * distance.interval.maximum);
        };
        add(series, summary.mean_speed_mps + aside_mps, 1);
        const double radius_m = turn_radius_m(summary.mean_speed_mps), trees = 1 / blind_km(per_tree_m2);
        add(without_unit.series[i], std::log10(radius_m * radius_m / per_tree_m2), trees);
      }
      panel.series.push_back(series);
    }
    panels.push_back(panel);
  }
  for (const double speed_mps : {9.0, 10.0, 11.0, 12.0}) {
    const double radius_m = turn_radius_m(speed_mps), critical = critical_m2(radius_m),
                 trees = radius_m * radius_m / critical;
    section.row("phase",
                fmt::format("{:.0f} | {:.1f} | {:.1f} | {:.1f}", speed_mps, radius_m, critical, trees));
    section.row("sight", fmt::format("{:.0f} | {:.1f} | {:.1f} | {:.1f}", speed_mps,
                                     needed_sight_m(speed_mps, 2, false), needed_sight_m(speed_mps, 2, true),
                                     needed_sight_m(speed_mps, std::numbers::sqrt2, true)));
    if (speed_mps == 9 || speed_mps == 12)
      without_unit.references.push_back({std::log10(trees), speed_mps == 9 ? "no way" : "", true});
    for (const double per_tree_m2 : {49.0, 25.0, 16.0, 9.0}) {
      std::string cells = fmt::format("{:.0f} | {:.0f}", speed_mps, std::sqrt(per_tree_m2));
      for (const Eyes& eyes : all_eyes)
        cells += " | " + crash_distance_text(summary_of(flown.at(eyes.name).at({per_tree_m2, speed_mps})));
      section.row("map", cells);
    }
  }
  panels.push_back(without_unit);
  panels.push_back(sight_panel(flown));
  section.pictures["map"] = to_svg(panels, 3);
  return section;
}

}  // namespace understory
