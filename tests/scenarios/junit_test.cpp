#include "scenarios/campaign/gate.hpp"

#include <gtest/gtest.h>

#include <pugixml.hpp>

#include "scenarios/output/program.hpp"
#include "tests/support/flight_rows.hpp"

namespace understory {
namespace {

using support::failed_row;
using support::flown_row;

pugi::xml_node parse(pugi::xml_document& document, const std::string& text) {
  const pugi::xml_parse_result result = document.load_string(text.c_str());
  EXPECT_TRUE(result) << result.description() << "\n" << text;
  return document.child("testsuites");
}

std::string counts(const pugi::xml_node& node) {
  return std::string(node.attribute("tests").value()) + " " + node.attribute("failures").value() + " " +
         node.attribute("errors").value();
}

std::string message(const pugi::xml_node& top, const std::string& suite, const std::string& name,
                    const char* kind) {
  return top.find_child_by_attribute("testsuite", "name", suite.c_str())
      .find_child_by_attribute("testcase", "name", name.c_str())
      .child(kind)
      .attribute("message")
      .value();
}

TEST(CampaignJunit, IsACasePerFlight) {
  pugi::xml_document document;
  const pugi::xml_node top = parse(
      document, campaign_junit({flown_row("forest", 1, "goal"), flown_row("forest", 2, "collision", 31.25),
                                flown_row("dense", 1, "time", 12),
                                failed_row("forest", 3, "hung after 300 s", RunStatus::hung)}));
  EXPECT_EQ(counts(top), "4 2 1");
  const pugi::xml_node forest = top.first_child();
  EXPECT_STREQ(forest.attribute("name").value(), "forest");
  EXPECT_EQ(counts(forest), "3 1 1");
  EXPECT_STREQ(forest.attribute("time").value(), "13.800");
  EXPECT_STREQ(forest.child("properties").child("property").attribute("value").value(), understory_version);
  EXPECT_STREQ(forest.child("testcase").attribute("classname").value(), "forest");
  EXPECT_STREQ(forest.child("testcase").attribute("time").value(), "6.900");
  EXPECT_TRUE(forest.child("testcase").first_child().empty());
  EXPECT_EQ(message(top, "forest", "2", "failure"), "collision at 31.2 m of 75.0 m");
  EXPECT_EQ(message(top, "forest", "3", "error"), "hung after 300 s");
  EXPECT_EQ(message(top, "dense", "1", "failure"), "time at 12.0 m of 75.0 m");
}

TEST(CampaignJunit, OddCharactersComeBackOrBecomeQuestionMarks) {
  const std::string odd = "<a href=\"x\">&'\xc3\xa9\xe2\x82\xac</a>";
  pugi::xml_document document;
  const pugi::xml_node top = parse(document, campaign_junit({failed_row("forest", 1, odd)}));
  EXPECT_EQ(message(top, "forest", "1", "error"), odd);

  // A terminal's colours, a lone byte, an overlong slash, a surrogate, a letter cut off: none is XML.
  const std::string broken = "\x1b[31mred\x01 \xff \xc0\xaf \xed\xa0\x80 \xe2\x82";
  pugi::xml_document other;
  const std::string text = campaign_junit({failed_row("forest", 1, broken)});
  EXPECT_EQ(message(parse(other, text), "forest", "1", "error"), "?[31mred? ? ?? ??? ??");
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= 0x20 && c < 0x7f)) << static_cast<int>(c);
}

TEST(GateJunit, FailsWhatGotWorse) {
  const std::vector<FlightRow> baseline{
      flown_row("forest", 1, "goal"), flown_row("forest", 2, "collision", 20), flown_row("forest", 3, "goal"),
      flown_row("forest", 4, "goal"), flown_row("forest", 5, "goal")};
  const std::vector<FlightRow> candidate{flown_row("forest", 1, "goal"), flown_row("forest", 2, "ground", 25),
                                         flown_row("forest", 3, "collision", 30),
                                         failed_row("forest", 4, "signal 11"),
                                         flown_row("forest", 6, "collision", 5)};
  pugi::xml_document document;
  const pugi::xml_node top = parse(document, gate_junit(compare_campaigns(baseline, candidate)));
  EXPECT_EQ(counts(top), "7 2 2");  // six flights and the condition
  EXPECT_EQ(message(top, "forest", "2", "failure"), "");
  EXPECT_EQ(message(top, "forest", "3", "failure"),
            "collision at 30.0 m of 75.0 m; reached its goal in the baseline");
  EXPECT_EQ(message(top, "forest", "4", "error"), "signal 11");
  EXPECT_EQ(message(top, "forest", "5", "error"), "in the baseline, missing in the candidate");
  EXPECT_EQ(message(top, "gate", "forest", "failure"),
            "success fell from 2 to 1 of 3, by 33.3 percentage points (5.0 allowed), p = 1");

  pugi::xml_document lenient;
  EXPECT_EQ(counts(parse(lenient, gate_junit(compare_campaigns(baseline, candidate), {0.4}))), "7 1 2");
}

TEST(GateJunit, NothingIsStillXml) {
  pugi::xml_document document;
  EXPECT_EQ(counts(parse(document, gate_junit(compare_campaigns({}, {})))), "0 0 0");
}

}  // namespace
}  // namespace understory
