#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <regex>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/report/line_plot.hpp"
#include "scenarios/report/table.hpp"
#include "tests/support/text.hpp"

namespace understory {
namespace {

using namespace support;

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
    ++found;
  return found;
}

LinePlot small_plot() {
  LinePlot plot;
  plot.title = "A < B & C";
  plot.x_label = "time (s)";
  plot.y_label = "height (m)";
  plot.series = {{"flown", {0, 1, 2, 3}, {0, 2, 4, 6}}, {"asked", {1, 2}, {1, 1}, Mark::dots}};
  plot.references = {{5, "limit", false}};
  return plot;
}

TEST(LinePlot, TicksAreRoundNumbersWithinTheAxis) {
  EXPECT_EQ(tick_positions({0, 10}, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(tick_positions({-1, 1}, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  for (const AxisRange range : {AxisRange{0.0031, 0.0187}, AxisRange{-730, 12}, AxisRange{99.2, 99.9}}) {
    const std::vector<double> ticks = tick_positions(range, 6);
    EXPECT_GE(ticks.size(), 3u);
    EXPECT_LE(ticks.size(), 11u);
    const double step = ticks[1] - ticks[0];
    const double mantissa = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    EXPECT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
                std::abs(mantissa - 5) < 1e-6)
        << step;
    for (const double tick : ticks) {
      EXPECT_GE(tick, range.minimum - 1e-9);
      EXPECT_LE(tick, range.maximum + 1e-9);
    }
  }
}

TEST(LinePlot, HoldsWhatItWasGiven) {
  const std::string svg = to_svg({small_plot()});
  for (const char* part : {"time (s)", "height (m)", "flown", "asked", "limit", "A &lt; B &amp; C"})
    expect_part(svg, part);
  expect_no_part(svg, "A < B");
  EXPECT_EQ(count(svg, "<circle"), 3);  // two points and their legend entry
  EXPECT_EQ(count(svg, "<svg"), 1);
  EXPECT_EQ(count(svg, "<g"), count(svg, "</g>"));
}

/// The path's corners are where the numbers are: evenly spaced numbers on a line give evenly spaced corners,
/// y upwards.
TEST(LinePlot, ScalesAreLinear) {
  const std::string svg = to_svg({small_plot()});
  const std::regex corner(R"re(M([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)L)re");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(svg, match, corner));
  const auto number = [&](int i) { return std::stod(match[static_cast<std::size_t>(i)]); };
  EXPECT_NEAR(number(3) - number(1), number(5) - number(3), 0.11);
  EXPECT_NEAR(number(4) - number(2), number(6) - number(4), 0.11);
  EXPECT_LT(number(4), number(2));
}

/// Equal ratios are equal distances; what has no logarithm lies on the frame.
TEST(LinePlot, ALogarithmicAxisShowsRatios) {
  LinePlot plot = small_plot();
  plot.references.clear();
  plot.series = {{"decades", {0, 1, 2}, {1, 10, 100}, Mark::line, -1, {0, 1, 50}, {2, 20, HUGE_VAL}}};
  plot.y_log = true;
  const std::string svg = to_svg({plot});
  std::smatch match;
  ASSERT_TRUE(std::regex_search(
      svg, match, std::regex(R"re(M([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)" stroke)re")));
  const auto number = [&](int i) { return std::stod(match[static_cast<std::size_t>(i)]); };
  EXPECT_NEAR(number(2) - number(4), number(4) - number(6), 0.11);
  EXPECT_GT(number(2) - number(4), 50);
  for (const char* tick : {">1<", ">2<", ">50<", ">100<"}) expect_part(svg, tick);
  for (const char* wrong : {"inf", "nan"}) expect_no_part(svg, wrong);
}

TEST(LinePlot, WhatIsNotANumberInterruptsTheLine) {
  LinePlot plot = small_plot();
  plot.series = {{"gap", {0, 1, 2, 3, 4}, {0, 1, std::numeric_limits<double>::quiet_NaN(), 3, 4}}};
  const std::string svg = to_svg({plot});
  expect_no_part(svg, "nan");
  EXPECT_TRUE(std::regex_search(svg, std::regex(R"re(d="M[0-9. ]+L[0-9. ]+M[0-9. ]+L[0-9. ]+")re")));
}

TEST(LinePlot, ErrorBarsAndBandsAreDrawn) {
  LinePlot plot = small_plot();
  plot.series[0].low = {-1, 1, 3, 5};
  plot.series[0].high = {1, 3, 5, 7};
  EXPECT_EQ(count(to_svg({plot}), "<polygon"), 0);
  plot.series[0].band = true;
  EXPECT_EQ(count(to_svg({plot}), "<polygon"), 1);
}

TEST(LinePlot, PanelsStandInRowsAndColumns) {
  const std::string svg = to_svg({small_plot(), small_plot(), small_plot()}, 2);
  EXPECT_EQ(count(svg, "class=\"title\""), 3);
  expect_part(svg, "width=\"920\"");
}

TEST(Table, LinesUpForPeopleAndForMarkdown) {
  const Table table{{"a|b", "m²"}, {{"long name", "1"}, {"é", "1000"}}};
  EXPECT_EQ(to_text(table), "a|b          m²\nlong name     1\né          1000\n");
  EXPECT_EQ(to_markdown(table), "| a\\|b | m² |\n|---|---:|\n| long name | 1 |\n| é | 1000 |\n");
  EXPECT_EQ(to_markdown({{"key", "meaning"}, {{"a", "said"}}}),
            "| key | meaning |\n|---|---|\n| a | said |\n");
}

TEST(Table, QuotesCellsAsRfc4180Says) {
  // The RFC's own examples, section 2, rules 5 to 7, with this writer's line ends.
  const Table table{{"aaa", "bbb", "ccc"}, {{"a,a", "b\nb", "c\"c"}, {"zzz", "", " x "}}};
  const std::string csv = "aaa,bbb,ccc\n\"a,a\",\"b\nb\",\"c\"\"c\"\nzzz,, x \n";
  EXPECT_EQ(to_csv(table), csv);
  const Table again = table_from_csv(csv, "t.csv");
  EXPECT_EQ(again.head, table.head);
  EXPECT_EQ(again.rows, table.rows);
  for (const char* same : {"a,b\r\n\"1\",2\r\n", "a,b\n1,2", "\"a\",\"b\"\n1,\"2\"\n"})
    EXPECT_EQ(to_csv(table_from_csv(same, "t.csv")), "a,b\n1,2\n") << same;
  EXPECT_EQ(table_from_csv("a\n\"\"\"\"\n", "t.csv").rows[0][0], "\"");
  EXPECT_TRUE(table_from_csv("", "t.csv").head.empty());
}

TEST(Table, NamesTheLineThatIsNoCsv) {
  const auto refusal = [](const std::string& csv) {
    return support::refusal_of([&] { table_from_csv(csv, "t.csv"); });
  };
  EXPECT_EQ(refusal("a,b\n1,2\n3\n"), "t.csv:3: expected a whole row of 2 values");
  EXPECT_EQ(refusal("a\n\"1\n2\"\n3,4\n"), "t.csv:4: expected a whole row of 1 values");
  for (const char* broken : {"a\n\"1\n", "a\n1\"\n", "a\n\"1\"2\n", "a\n1\"2\"\n"})
    EXPECT_EQ(refusal(broken).find("t.csv:2: expected quotation marks"), 0u) << broken << refusal(broken);
}

}  // namespace
}  // namespace understory
