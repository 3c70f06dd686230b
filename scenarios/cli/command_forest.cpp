#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/course/inventory.hpp"
#include "scenarios/course/stand_statistics.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/report/line_plot.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct ForestArguments {
  std::string scenario = "forest";
  std::vector<std::string> settings;
  std::string against;
  std::string out;  ///< empty: no picture
  int stands = 40;
};

Stand stand_of(const std::vector<Obstacle>& trunks, const ForestConfig& forest) {
  Stand stand;
  stand.window = {Eigen::Vector2d(forest.clear_m, -forest.half_width_m),
                  Eigen::Vector2d(forest.clear_m + forest.length_m, forest.half_width_m)};
  for (const Obstacle& trunk : trunks) {
    stand.places.push_back(trunk.from_world.head<2>());
    stand.diameters_m.push_back(2 * trunk.radius_m);
  }
  return stand;
}

std::vector<Stand> stands_of(Scenario scenario, int count) {
  std::vector<Stand> stands;
  const bool measured = !scenario.forest.trees_file.empty();
  const std::vector<Stem> stems = measured ? stems_of(scenario.forest) : std::vector<Stem>{};
  for (int i = 0; i < count; ++i, ++scenario.seed)
    stands.push_back(stand_of(measured ? place_stems(stems, scenario.forest, scenario.seed).obstacles
                                       : random_forest(scenario.forest, scenario.seed),
                              scenario.forest));
  return stands;
}

/// The measured forest beside which the scenario's stands: stems as thick as its thinnest, courses of its
/// size.
std::optional<Scenario> measured_beside(const Scenario& scenario, const ForestArguments& arguments) {
  Scenario measured = scenario;
  const std::string name = arguments.against.empty() ? "scbi-2008.csv" : arguments.against;
  measured.forest.trees_file = found_trees_file(name, "");
  std::error_code ignored;
  if (arguments.against.empty() && !fs::exists(measured.forest.trees_file, ignored)) return std::nullopt;
  if (scenario.forest.trees_file.empty()) measured.forest.thinnest_stem_m = 2 * scenario.forest.radius_min_m;
  measured.forest.file_x_m = measured.forest.file_y_m = measured.forest.file_heading_rad = std::nullopt;
  measured.seed = 1;
  return measured;
}

Table table_of(const std::string& name, const StandFigures& own, const StandFigures* measured) {
  Table table{{"", name}};
  if (measured != nullptr) table.head.emplace_back("measured forest");
  const auto add = [&](const std::string& what, const auto& value, int decimals) {
    const auto text = [&](const StandFigures& of) {
      return number_text(static_cast<double>(std::invoke(value, of)), decimals);
    };
    table.rows.push_back({what, text(own)});
    if (measured != nullptr) table.rows.back().push_back(text(*measured));
  };
  add("stands", &StandFigures::stands, 0);
  add("stems", &StandFigures::stems, 0);
  add("stems per hectare", &StandFigures::stems_per_ha, 0);
  add("basal area, m^2 per hectare", &StandFigures::basal_area_m2_per_ha, 1);
  add("diameter, median, m", &StandFigures::median_m, 3);
  add("diameter, nine tenths below, m", &StandFigures::upper_tenth_m, 3);
  add("diameter, largest, m", &StandFigures::largest_m, 3);
  add("Clark-Evans index", &StandFigures::clark_evans, 3);
  for (std::size_t i = 0; i < std::size(ripley_radii_m); ++i)
    add(
        fmt::format("Ripley's L(r) - r at {} m", ripley_radii_m[i]),
        [i](const StandFigures& of) { return of.l_minus_r[i]; }, 2);
  return table;
}

Series curve_of(const std::string& name, const StandFigures& figures) {
  Series series{name, {std::begin(ripley_radii_m), std::end(ripley_radii_m)}, figures.l_minus_r};
  series.low = figures.low;
  series.high = figures.high;
  series.band = true;
  return series;
}

Series diameters_of(const std::string& name, const std::vector<Stand>& stands) {
  std::vector<double> sorted;
  for (const Stand& stand : stands)
    sorted.insert(sorted.end(), stand.diameters_m.begin(), stand.diameters_m.end());
  std::ranges::sort(sorted);
  Series series{name};
  const std::size_t step = std::max<std::size_t>(1, sorted.size() / 300);
  for (std::size_t i = 0; i < sorted.size(); i += step) {
    series.x.push_back(sorted[i]);
    series.y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(sorted.size()));
  }
  return series;
}

LinePlot plan_of(const std::string& title, const Stand& stand) {
  LinePlot plot{title, "x, m", "y, m"};
  plot.equal_scale = true;
  for (const auto& [name, low_m, high_m] :
       {std::tuple("below 10 cm", 0.0, 0.1), {"10 to 30 cm", 0.1, 0.3}, {"thicker", 0.3, 100.0}}) {
    Series series{name};
    series.mark = Mark::dots;
    for (std::size_t i = 0; i < stand.places.size(); ++i) {
      if (stand.diameters_m[i] < low_m || stand.diameters_m[i] >= high_m) continue;
      series.x.push_back(stand.places[i].x());
      series.y.push_back(stand.places[i].y());
    }
    if (!series.x.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

int run_forest(const ForestArguments& arguments) {
  const fs::path out = arguments.out;
  if (!out.empty() && out.extension() != ".svg")
    throw ScenarioError(fmt::format("--out {}: the name must end in .svg", arguments.out));
  const fs::path file = scenario_file(arguments.scenario);
  const Scenario scenario = load_scenario(file, arguments.settings);
  if (scenario.course != "forest")
    throw ScenarioError(fmt::format("{}: course: must be forest, for this command",
                                    where_given(file, arguments.settings, "course")));
  require_separate({out}, {file});
  require_writable(out);
  const std::vector<Stand> own = stands_of(scenario, arguments.stands);
  const StandFigures figures = figures_of(own);
  const std::optional<Scenario> beside = measured_beside(scenario, arguments);
  std::vector<Stand> measured;
  std::optional<StandFigures> measured_figures;
  if (beside) {
    measured = stands_of(*beside, 100);
    measured_figures = figures_of(measured);
  }
  fmt::print("{}",
             to_text(table_of(scenario.name, figures, measured_figures ? &*measured_figures : nullptr)));
  if (measured_figures) {
    const StandTests tests = compare(own, measured);
    fmt::print(
        "diameters: Kolmogorov-Smirnov distance {:.3f}, p {:.3f}\n"
        "places: studentised permutation test of Ripley's K, p {:.3f}\n",
        tests.ks_distance, tests.ks_p, tests.k_p);
  } else {
    fmt::print("scbi-2008.csv was not found: nothing to compare with (docs/woods.md)\n");
  }
  if (out.empty()) return exit_goal;
  std::vector<LinePlot> plots{
      plan_of(fmt::format("{}, seed {}", scenario.name, scenario.seed), own.front()),
      {"Ripley's L(r) - r: mean, 95 % of the stands",
       "distance r, m",
       "L(r) - r, m",
       {curve_of(scenario.name, figures)}},
      {"Diameters", "diameter, m", "stems below, %", {diameters_of(scenario.name, own)}}};
  if (measured_figures) {
    plots.insert(plots.begin() + 1, plan_of("measured forest", measured.front()));
    plots[2].series.push_back(curve_of("measured forest", *measured_figures));
    plots[3].series.push_back(diameters_of("measured forest", measured));
  }
  write_whole_file(out, to_svg(plots, 2));
  fmt::print("picture: {}\n", arguments.out);
  return exit_goal;
}

}  // namespace

void add_forest_command(CommandLine& line) {
  const auto arguments = std::make_shared<ForestArguments>();
  Command& command =
      line.add({"forest", "describe a scenario's forest in foresters' figures, beside a measured one",
                "understory forest dense --out forest.svg"});
  command.text("scenario", "SCENARIO", arguments->scenario, "scenario whose course is forest");
  command.texts("--set", "KEY=VALUE", arguments->settings, "override a key of the scenario; repeatable");
  command.whole("--stands", arguments->stands, 2, 10'000,
                "number of forests that are described together, from the scenario's seed on");
  command.text(
      "--against", "FILE", arguments->against,
      "table of measured stems to compare with (default: scbi-2008.csv in the folder that UNDERSTORY_DATA "
      "names)");
  command.text("--out", "FILE", arguments->out,
               "write an .svg drawing: places from above, Ripley's L, diameters");
  command.runs([arguments] { return run_forest(*arguments); });
}

}  // namespace understory
