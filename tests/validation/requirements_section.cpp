#include <fmt/format.h>

#include <cmath>
#include <map>
#include <random>

#include "perception/io/text_table.hpp"
#include "scenarios/explain/explanation.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "tests/validation/sections.hpp"

/// What vision must be able to do: success over each property of the synthetic detector, and where it falls.
namespace understory {
namespace {

constexpr double asked = 0.95;

constexpr std::array<const char*, 3> detectors{"pushbroom", "StereoBM", "StereoSGBM"};
struct Property {
  const char *name, *label;
  std::array<double, detectors.size()> measured;  ///< docs/limits.md says how; NAN: says nothing of it
};
// All three tuned, on recordings of the long rig (docs/evaluate.md): obstacles found within 3 m, recall, and
// false positives a frame (full stereo's over all depths that it sees, as described.yaml has them); rate and
// latency on the aircraft's computer (docs/thesis.md), which needs 8 ms for the pushbroom.
constexpr std::array<Property, 9> properties{
    {{"reach", "sees up to (m)", {NAN, 15, 15}},
     {"one depth", "looks at one depth (m)", {10.14, NAN, NAN}},
     {"rate", "looks so often (Hz)", {120, 14, 12}},
     {"latency", "answers after (s)", {0.016, 0.08, 0.091}},
     {"missed for good", "share of trees never seen", {0.013, 0.004, 0.009}},
     {"missed in a frame", "share of frames that miss a tree", {NAN, NAN, NAN}},
     {"blocks missed", "share of blocks missed", {0.675, 0.27, 0.4}},
     {"false points", "false points a frame at 120 Hz", {0.22, 4 * 14 / 120.0, 2.1 * 12 / 120}},
     {"disparity error", "error of disparity (px)", {NAN, 0.5, NAN}}}};

struct Cell {
  double per_tree_m2 = 0, speed_mps = 0;
  auto operator<=>(const Cell&) const = default;
};
constexpr std::array<Cell, 4> cells{{{49, 9}, {49, 12}, {16, 9}, {16, 12}}};

/// One property at one speed and density, from its best value to its worst.
struct Curve {
  std::vector<double> values;
  std::vector<Share> arrived;
};

std::map<std::string, std::map<Cell, Curve>> flown_curves() {
  const std::string file = UNDERSTORY_SOURCE_DIR "/docs/results/limits/requirements.csv";
  const std::string text = read_file(file, 1 << 20);
  constexpr std::array<Column, 6> columns{
      {{"property"}, {"value"}, {"speed_mps"}, {"square_metres_per_tree"}, {"arrived"}, {"flown"}}};
  std::map<std::string, std::map<Cell, Curve>> curves;
  for (const TableLine& line : named_table(text, CellsParted::by_commas, file, columns).lines) {
    const auto number = [&](std::size_t i) { return std::stod(std::string(line.cells[i])); };
    Curve& curve = curves[std::string(line.cells[0])][{number(3), number(2)}];
    curve.values.push_back(number(1));
    curve.arrived.push_back({static_cast<std::int64_t>(number(5)), static_cast<std::int64_t>(number(4))});
  }
  return curves;
}

/// Where a success that only falls crosses what is asked, in entries of the curve from 0 on: -1 if it is less
/// from the first on, the number of entries if it never is.
double crossing(const std::vector<Share>& arrived) {
  std::vector<double> fitted = monotone_fit(std::vector<Share>(arrived.rbegin(), arrived.rend()));
  std::ranges::reverse(fitted);
  const auto below = static_cast<std::size_t>(
      std::ranges::find_if(fitted, [](double share) { return share < asked; }) - fitted.begin());
  if (below == 0) return -1;
  if (below == fitted.size()) return static_cast<double>(fitted.size());
  return static_cast<double>(below) - (asked - fitted[below]) / (fitted[below - 1] - fitted[below]);
}

/// The 95 % interval of the crossing: each entry's success drawn anew from what its flights leave open
/// (Jeffreys' beta distribution).
Interval interval_of(const std::vector<Share>& arrived) {
  std::mt19937_64 generator(1);
  std::vector<double> drawn(1000);
  for (double& one : drawn) {
    std::vector<Share> again;
    for (const Share& share : arrived) {
      const double with = std::gamma_distribution<double>(static_cast<double>(share.with) + 0.5)(generator),
                   without = std::gamma_distribution<double>(static_cast<double>(share.of - share.with) +
                                                             0.5)(generator);
      again.push_back(
          {share.of * 1000, std::llround(1000 * static_cast<double>(share.of) * with / (with + without))});
    }
    one = crossing(again);
  }
  return {quantile(drawn, 0.025), quantile(drawn, 0.975)};
}

/// The value at a place among the entries, or that it lies beyond them.
std::string value_at(const std::vector<double>& values, double place) {
  if (place < 0) return "never";
  if (place > static_cast<double>(values.size() - 1)) return fmt::format("beyond {}", values.back());
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, values.size() - 1);
  return fmt::format("{:.3g}", std::lerp(values[before], values[after], place - static_cast<double>(before)));
}

/// The place of a value among entries that rise or fall, at an end where it lies beyond.
double place_of(const std::vector<double>& values, double value) {
  const double sign = values.back() > values.front() ? 1 : -1;
  for (std::size_t i = 0; i + 1 < values.size(); ++i)
    if (sign * value <= sign * values[i + 1])
      return static_cast<double>(i) + std::max(0.0, (value - values[i]) / (values[i + 1] - values[i]));
  return static_cast<double>(values.size() - 1);
}

LinePlot panel_of(const Property& property, const std::map<Cell, Curve>& curves) {
  LinePlot panel{.title = property.label,
                 .y_label = "arrived (%)",
                 .references = {{100 * asked, "95 %", false}},
                 .y_range = AxisRange{-15, 102}};  // the names of the values stand below 0
  const std::vector<double>& values = curves.begin()->second.values;
  for (std::size_t i = 0; i < values.size(); ++i)
    panel.x_names.emplace_back(static_cast<double>(i), fmt::format("{}", values[i]));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Series series{
        .name = fmt::format("{:.0f} m/s, {:.0f} m", cells[i].speed_mps, std::sqrt(cells[i].per_tree_m2)),
        .mark = Mark::line_and_dots};
    const Curve& curve = curves.at(cells[i]);
    for (std::size_t k = 0; k < curve.values.size(); ++k) {
      const Share& share = curve.arrived[k];
      const Interval interval = wilson_interval(static_cast<int>(share.with), static_cast<int>(share.of));
      series.add(static_cast<double>(k) + 0.06 * (static_cast<double>(i) - 1.5), 100 * share.value(),
                 100 * interval.minimum, 100 * interval.maximum);
    }
    panel.series.push_back(series);
  }
  for (std::size_t i = 0; i < detectors.size(); ++i) {
    if (std::isnan(property.measured[i])) continue;
    const double at = place_of(values, property.measured[i]);
    panel.series.push_back({.name = detectors[i],
                            .x = {at, at},
                            .y = {0, 102},
                            .mark = Mark::dashes,
                            .colour = static_cast<int>(4 + i)});
  }
  return panel;
}

}  // namespace

Section requirements_section() {
  Section section{"requirements"};
  const auto curves = flown_curves();
  std::vector<LinePlot> panels;
  for (const Property& property : properties) {
    const std::map<Cell, Curve>& its = curves.at(property.name);
    std::string row = property.label;
    for (const Cell& cell : cells) {
      const Curve& curve = its.at(cell);
      const Interval interval = interval_of(curve.arrived);
      const std::string value = value_at(curve.values, crossing(curve.arrived)),
                        first = value_at(curve.values, interval.minimum),
                        last = value_at(curve.values, interval.maximum);
      row += " | " + value + (first == last ? "" : fmt::format(" ({} to {})", first, last));
    }
    for (const double value : property.measured)
      row += std::isfinite(value) ? fmt::format(" | {:.3g}", value) : " | ";
    section.row("table", row);
    panels.push_back(panel_of(property, its));
  }
  section.pictures["requirements"] = to_svg(panels, 3);
  return section;
}

}  // namespace understory
