#include "scenarios/report/line_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "perception/assertion.hpp"

namespace understory {
namespace {

// Okabe & Ito 2008: eight colours that people with any colour vision can tell apart; yellow, too faint for a
// line on white, is darkened.
constexpr std::array<const char*, 8> palette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#56b4e9", "#e69f00", "#b8a800", "#000000"};

constexpr double panel_width = 460, plot_height = 250;
constexpr double left = 62, right = 14, top = 30, bottom = top + plot_height, below_axis = 46,
                 legend_line = 17;
constexpr double character_width = 6.3;  // of the 11 px sans-serif face, on the wide side

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text)
    safe += letter == '&'   ? "&amp;"
            : letter == '<' ? "&lt;"
            : letter == '>' ? "&gt;"
                            : std::string(1, letter);
  return safe;
}

/// UTF-8 text's width: continuation bytes take none.
double text_width(const std::string& text) {
  const auto letters = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; });
  return character_width * static_cast<double>(letters);
}

/// Widens `range` to hold `value`, if that is a number.
void include(AxisRange& range, double value) {
  if (!std::isfinite(value)) return;
  range.minimum = std::min(range.minimum, value);
  range.maximum = std::max(range.maximum, value);
}

/// A little more than `range`, so that nothing lies on the frame; something to show where it is empty.
AxisRange padded(AxisRange range) {
  if (range.minimum > range.maximum) return {0, 1};  // nothing to show
  const double room = range.maximum > range.minimum ? 0.05 * (range.maximum - range.minimum)
                                                    : std::max(0.5 * std::abs(range.minimum), 0.5);
  return {range.minimum - room, range.maximum + room};
}

/// Between ticks.
double tick_step(AxisRange range, int wanted) {
  const double rough = (range.maximum - range.minimum) / std::max(1, wanted);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / power;
  return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

/// Digits behind the point that a tick's label needs.
int decimals(double step) { return std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9))); }

/// In the axis's own unit: decades where it is logarithmic.
double scaled(double value, bool log) { return log ? std::log10(value) : value; }

AxisRange covering(const LinePlot& plot, bool vertical_axis) {
  AxisRange range{HUGE_VAL, -HUGE_VAL};
  const auto take = [&](double value) { include(range, scaled(value, vertical_axis && plot.y_log)); };
  for (const Series& series : plot.series) {
    for (const double value : vertical_axis ? series.y : series.x) take(value);
    if (!vertical_axis) continue;
    for (const double value : series.low) take(value);
    for (const double value : series.high) take(value);
  }
  for (const ReferenceLine& line : plot.references)
    if (line.vertical != vertical_axis) take(line.at);
  return padded(range);
}

/// `more`: further attributes.
std::string label(double x, double y, const std::string& text, const char* more) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, more, escaped(text));
}

std::string straight(double x, double y, const char* direction, double to, const char* kind) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}{}{:.1f}\" class=\"{}\"/>", x, y, direction, to, kind);
}

std::string dot(double x, double y, const char* colour) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.2\" fill=\"{}\"/>\n", x, y, colour);
}

std::string line(const std::string& corners, const Series& series, const char* colour) {
  return fmt::format("<path d=\"{}\" stroke=\"{}\" class=\"line\"{}/>\n", corners, colour,
                     series.mark == Mark::dashes ? " stroke-dasharray=\"6 4\"" : "");
}

bool has_line(const Series& series) { return series.mark != Mark::dots; }
bool has_dots(const Series& series) {
  return series.mark == Mark::dots || series.mark == Mark::line_and_dots;
}

/// One panel: where numbers lie on the paper.
class Panel {
 public:
  Panel(const LinePlot& plot, int number) : plot_(plot), number_(number) {
    x_ = plot.x_range.value_or(covering(plot, false));
    y_ = plot.y_range
             ? AxisRange{scaled(plot.y_range->minimum, plot.y_log), scaled(plot.y_range->maximum, plot.y_log)}
             : covering(plot, true);
    if (plot.equal_scale) make_scales_equal();
  }

  double height() const { return bottom + below_axis + legend_line * legend_rows() + 6; }

  std::string svg() const {
    std::string text;
    draw_axes(text);
    text +=
        fmt::format("<clipPath id=\"c{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
                    number_, left, top, width(), plot_height);
    text += fmt::format("<g clip-path=\"url(#c{})\">\n", number_);
    for (std::size_t i = 0; i < plot_.series.size(); ++i) draw_spread(text, plot_.series[i], colour(i));
    for (const ReferenceLine& line : plot_.references) draw_reference(text, line);
    for (std::size_t i = 0; i < plot_.series.size(); ++i) draw_series(text, plot_.series[i], colour(i));
    text += "</g>\n";
    draw_legend(text);
    return text;
  }

 private:
  static double width() { return panel_width - left - right; }
  double at_x(double x) const { return left + (x - x_.minimum) / (x_.maximum - x_.minimum) * width(); }
  double at_y(double y) const {
    const double place = scaled(y, plot_.y_log);
    return bottom - ((plot_.y_log ? std::clamp(place, y_.minimum, y_.maximum) : place) - y_.minimum) /
                        (y_.maximum - y_.minimum) * plot_height;
  }
  /// Value and label. On a logarithmic axis 1, 2 and 5 times the powers of ten.
  std::vector<std::pair<double, std::string>> y_ticks() const {
    constexpr int wanted = 6;
    std::vector<std::pair<double, std::string>> ticks;
    if (!plot_.y_log) {
      const int digits = decimals(tick_step(y_, wanted));
      for (const double tick : tick_positions(y_, wanted))
        ticks.emplace_back(tick, fmt::format("{:.{}f}", tick, digits));
      return ticks;
    }
    for (double power = std::floor(y_.minimum); power <= y_.maximum; ++power)
      for (const double times : {1, 2, 5}) {
        const double tick = times * std::pow(10, power), place = std::log10(tick);
        if (place >= y_.minimum && place <= y_.maximum) ticks.emplace_back(tick, fmt::format("{:g}", tick));
      }
    return ticks;
  }

  void make_scales_equal() {
    const double per_px =
        std::max((x_.maximum - x_.minimum) / width(), (y_.maximum - y_.minimum) / plot_height);
    const auto widen = [](AxisRange& range, double length) {
      const double more = 0.5 * (length - (range.maximum - range.minimum));
      range = {range.minimum - more, range.maximum + more};
    };
    widen(x_, per_px * width());
    widen(y_, per_px * plot_height);
  }

  const char* colour(std::size_t i) const {
    const int own = plot_.series[i].colour;
    return palette[(own >= 0 ? static_cast<std::size_t>(own) : i) % palette.size()];
  }

  void draw_axes(std::string& text) const {
    constexpr int wanted_x = 7;
    const int x_decimals = decimals(tick_step(x_, wanted_x));
    constexpr const char *middle = "text-anchor=\"middle\"", *end = "text-anchor=\"end\"";
    text += label(left, 18, plot_.title, "class=\"title\"");
    for (const auto& [x, name] : plot_.x_names)
      text +=
          fmt::format("<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" class=\"note\">{}</text>\n",
                      at_x(x) - 6, bottom - 6, escaped(name));
    for (const double tick : plot_.x_names.empty() ? tick_positions(x_, wanted_x) : std::vector<double>{}) {
      text += straight(at_x(tick), top, "V", bottom, "grid");
      text += label(at_x(tick), bottom + 15, fmt::format("{:.{}f}", tick, x_decimals), middle);
    }
    for (const auto& [tick, words] : y_ticks()) {
      text += straight(left, at_y(tick), "H", left + width(), "grid");
      text += label(left - 6, at_y(tick) + 4, words, end);
    }
    text += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" class=\"frame\"/>\n", left, top,
                        width(), plot_height);
    text += label(left + 0.5 * width(), bottom + 34, plot_.x_label, middle);
    text +=
        fmt::format("<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                    top + 0.5 * plot_height, escaped(plot_.y_label));
  }

  void draw_reference(std::string& text, const ReferenceLine& reference) const {
    if (reference.vertical) {
      const double x = at_x(reference.at);
      text += straight(x, top, "V", bottom, "reference");
      text += label(x + 4, top + 13, reference.label, "class=\"note\"");
    } else {
      const double y = at_y(reference.at);
      text += straight(left, y, "H", left + width(), "reference");
      text += label(left + width() - 4, y < top + 16 ? y + 12 : y - 4, reference.label,
                    "text-anchor=\"end\" class=\"note\"");
    }
  }

  void draw_spread(std::string& text, const Series& series, const char* colour) const {
    if (series.low.empty()) return;
    if (series.band) {
      std::string points;
      for (std::size_t i = 0; i < series.x.size(); ++i)
        points += fmt::format("{:.1f},{:.1f} ", at_x(series.x[i]), at_y(series.high[i]));
      for (std::size_t i = series.x.size(); i-- > 0;)
        points += fmt::format("{:.1f},{:.1f} ", at_x(series.x[i]), at_y(series.low[i]));
      text += fmt::format("<polygon points=\"{}\" fill=\"{}\" opacity=\"0.2\"/>\n", points, colour);
      return;
    }
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const double x = at_x(series.x[i]), low = at_y(series.low[i]), high = at_y(series.high[i]);
      const std::string head = std::isfinite(series.high[i]) ? fmt::format("M{:.1f} {:.1f}h6", x - 3, high)
                                                             : fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}l4 7",
                                                                           x - 4, high + 7, x, high);
      text +=
          fmt::format("<path d=\"M{:.1f} {:.1f}h6M{:.1f} {:.1f}V{:.1f}{}\" stroke=\"{}\" fill=\"none\"/>\n",
                      x - 3, low, x, low, high, head, colour);
    }
  }

  void draw_series(std::string& text, const Series& series, const char* colour) const {
    std::string corners, dots;
    bool pen_down = false;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const bool visible = std::isfinite(series.x[i]) && std::isfinite(series.y[i]);
      if (visible) {
        const double x = at_x(series.x[i]), y = at_y(series.y[i]);
        corners += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", x, y);
        dots += dot(x, y, colour);
      }
      pen_down = visible;
    }
    if (has_line(series)) text += line(corners, series, colour);
    if (has_dots(series)) text += dots;
  }

  /// Calls place(series number, x, row) for every legend entry; returns the rows taken.
  template <typename Place>
  int lay_out_legend(Place&& place) const {
    double x = left;
    int row = 0;
    bool any = false;
    for (std::size_t i = 0; i < plot_.series.size(); ++i) {
      if (plot_.series[i].name.empty()) continue;
      const double length = 34 + text_width(plot_.series[i].name);
      if (any && x + length > panel_width) {
        x = left;
        ++row;
      }
      place(i, x, row);
      x += length;
      any = true;
    }
    return any ? row + 1 : 0;
  }

  int legend_rows() const {
    return lay_out_legend([](std::size_t, double, int) {});
  }

  void draw_legend(std::string& text) const {
    lay_out_legend([&](std::size_t i, double x, int row) {
      const Series& series = plot_.series[i];
      const double y = bottom + below_axis + legend_line * row + 6;
      if (has_line(series)) text += line(fmt::format("M{:.1f} {:.1f}h20", x, y), series, colour(i));
      if (has_dots(series)) text += dot(x + 10, y, colour(i));
      text += label(x + 25, y + 4, series.name, "");
    });
  }

  const LinePlot& plot_;
  int number_;
  AxisRange x_;
  AxisRange y_;
};

void require_well_formed(const LinePlot& plot) {
  for (const Series& series : plot.series) {
    assert_always(series.x.size() == series.y.size(), "a series has as many x as y");
    assert_always(series.low.size() == series.high.size(), "a series has as many lower ends as upper ends");
    assert_always(series.low.empty() || series.low.size() == series.x.size(),
                  "a series has ends for every point");
  }
}

}  // namespace

std::vector<double> tick_positions(AxisRange range, int wanted) {
  const double step = tick_step(range, wanted);
  std::vector<double> ticks;
  for (double n = std::ceil(range.minimum / step - 1e-9); n * step <= range.maximum + 1e-9 * step; ++n)
    ticks.push_back(n == 0 ? 0.0 : n * step);  // no "-0"
  return ticks;
}

std::string to_svg(const std::vector<LinePlot>& panels, int columns) {
  std::string drawn;
  double y = 0, row_height = 0;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    require_well_formed(panels[i]);
    const std::size_t column = i % static_cast<std::size_t>(columns);
    if (column == 0) {
      y += row_height;
      row_height = 0;
    }
    const Panel panel(panels[i], static_cast<int>(i));
    drawn += fmt::format("<g transform=\"translate({} {})\">\n{}</g>\n",
                         panel_width * static_cast<double>(column), y, panel.svg());
    row_height = std::max(row_height, panel.height());
  }
  const double width = panel_width * static_cast<double>(std::min<std::size_t>(
                                         panels.size(), static_cast<std::size_t>(columns)));
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"DejaVu Sans, Helvetica, sans-serif\" font-size=\"11\">\n"
      "<style>.title{{font-size:13px;font-weight:bold}}.grid{{stroke:#e4e4e4}}.frame{{fill:none;stroke:#444}}"
      ".line{{fill:none;stroke-width:1.8}}.reference{{stroke:#777;stroke-dasharray:2 3;fill:none}}"
      ".note{{fill:#555;font-size:10px}}</style>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n{2}</svg>\n",
      width, y + row_height, drawn);
}

}  // namespace understory
