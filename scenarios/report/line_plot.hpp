#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace understory {

struct AxisRange {
  double minimum = 0;
  double maximum = 1;
};

/// Where an axis's ticks stand: multiples of 1, 2 or 5 times a power of ten, about `wanted` in `range`.
std::vector<double> tick_positions(AxisRange range, int wanted);

enum class Mark { line, dashes, dots, line_and_dots };

/// Numbers over numbers, of equal length. A value that is not finite interrupts the line.
struct Series {
  std::string name = {};  ///< in the legend; empty: not there
  std::vector<double> x = {};
  std::vector<double> y = {};
  Mark mark = Mark::line;
  int colour = -1;                ///< place in the palette (0 to 7); -1: the series' own place
  std::vector<double> low = {};   ///< empty, or the ends of error bars; an infinite end gets an arrow
  std::vector<double> high = {};  ///< as `low`
  bool band = false;              ///< shade between low and high instead of drawing bars

  /// One more number, and the ends of its bar.
  void add(double at, double value, double lower, double upper) {
    x.push_back(at), y.push_back(value);
    low.push_back(lower), high.push_back(upper);
  }
};

/// A straight line across the plot: a limit, a figure from elsewhere.
struct ReferenceLine {
  double at = 0;
  std::string label = {};
  bool vertical = false;
};

/// Axes with ticks, series and a legend beneath. Labels carry their units. Without a range an axis covers
/// what is drawn, and a little more.
struct LinePlot {
  std::string title = {};
  std::string x_label = {};
  std::string y_label = {};
  std::vector<Series> series = {};
  std::vector<ReferenceLine> references = {};
  /// Names of places along x, in the place of numbers: written upwards inside the frame.
  std::vector<std::pair<double, std::string>> x_names = {};
  std::optional<AxisRange> x_range = {};
  std::optional<AxisRange> y_range = {};
  bool y_log = false;  ///< the y axis is logarithmic; a bar that reaches 0 or infinity ends at the frame
  bool equal_scale = false;  ///< a metre is as long upwards as sideways: for paths
};

/// The panels side by side, `columns` to a row, as one SVG document. Text is escaped; no script, no links, no
/// fonts of its own.
std::string to_svg(const std::vector<LinePlot>& panels, int columns = 1);

}  // namespace understory
