#include "scenarios/campaign/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <regex>
#include <sstream>

#include "scenarios/output/program.hpp"

namespace understory {
namespace {

struct TestCase {
  std::string suite;
  std::string name;
  double time_s = 0;
  std::string fault = {};    ///< "failure" or "error", or "system-out" for a remark; empty: passed
  std::string message = {};  ///< of the fault or remark
};

/// '?' for what XML 1.0 cannot hold: broken UTF-8, which a JSON writer knows, control characters, and U+FFFE
/// and U+FFFF.
std::string without_odd_characters(const std::string& text) {
  using Json = nlohmann::json;
  static const std::regex odd("\xef\xbf\xbd|\xef\xbf\xbe|\xef\xbf\xbf");
  const std::string valid = Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
  std::string clean = std::regex_replace(valid, odd, "?");
  std::ranges::replace_if(
      clean, [](char c) { return c >= 0 && c < ' ' && !std::strchr("\t\n\r", c); }, '?');
  return clean;
}

void set(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(without_odd_characters(value).c_str());
}

void append_counts(pugi::xml_node node, const std::vector<TestCase>& cases) {
  double time_s = 0;
  for (const TestCase& test : cases) time_s += test.time_s;
  const auto count = [&](const char* fault) {
    return fmt::format("{}", std::ranges::count(cases, fault, &TestCase::fault));
  };
  set(node, "tests", fmt::format("{}", cases.size()));
  set(node, "failures", count("failure"));
  set(node, "errors", count("error"));
  set(node, "time", fmt::format("{:.3f}", time_s));
}

void append_case(pugi::xml_node suite, const TestCase& test) {
  pugi::xml_node node = suite.append_child("testcase");
  set(node, "classname", test.suite);
  set(node, "name", test.name);
  set(node, "time", fmt::format("{:.3f}", test.time_s));
  if (test.fault.empty()) return;
  pugi::xml_node fault = node.append_child(test.fault.c_str());
  if (test.fault == "system-out")
    fault.text().set(without_odd_characters(test.message).c_str());
  else
    set(fault, "message", test.message);
}

std::string to_junit(const std::string& name, const std::vector<TestCase>& cases) {
  std::vector<std::string> suites;
  for (const TestCase& test : cases)
    if (std::ranges::find(suites, test.suite) == suites.end()) suites.push_back(test.suite);

  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  set(declaration, "version", "1.0");
  set(declaration, "encoding", "UTF-8");
  pugi::xml_node top = document.append_child("testsuites");
  set(top, "name", name);
  append_counts(top, cases);
  for (const std::string& suite : suites) {
    std::vector<TestCase> own;
    std::ranges::copy_if(cases, std::back_inserter(own),
                         [&](const TestCase& test) { return test.suite == suite; });
    pugi::xml_node node = top.append_child("testsuite");
    set(node, "name", suite);
    append_counts(node, own);
    pugi::xml_node version = node.append_child("properties").append_child("property");
    set(version, "name", "understory");
    set(version, "value", understory_version);
    for (const TestCase& test : own) append_case(node, test);
  }
  std::ostringstream text;
  document.save(text, "  ");
  return text.str();
}

std::string outcome_of(const FlightRow& row) {
  return fmt::format("{} at {:.1f} m of {:.1f} m", row.outcome, row.progress_m, row.goal_m);
}

/// A flight that was flown passes, whatever its outcome.
TestCase case_of(const FlightRow& row) {
  TestCase test{row.condition, fmt::format("{}", row.seed), row.simulated_s};
  if (row.flown()) return test;
  test.fault = "error";
  test.message = row.reason.empty() ? "failed to run" : row.reason;
  return test;
}

}  // namespace

std::string campaign_junit(const std::vector<FlightRow>& rows) {
  std::vector<TestCase> cases;
  for (const FlightRow& row : rows) {
    TestCase& test = cases.emplace_back(case_of(row));
    if (!row.flown() || row.reached_goal()) continue;
    test.fault = "failure";
    test.message = outcome_of(row);
  }
  return to_junit("campaign", cases);
}

std::string gate_junit(const Comparison& comparison, const GateVerdict& verdict) {
  std::vector<TestCase> cases{{"gate", "verdict", 0, verdict.passes() ? "system-out" : "failure",
                               fmt::format("{}{}{}", verdict.name(), verdict.reasons.empty() ? "" : ": ",
                                           fmt::join(verdict.reasons, "; "))}};
  for (const ConditionComparison& condition : comparison.conditions)
    for (const FlightPair& pair : condition.pairs) {
      TestCase& test = cases.emplace_back(case_of(pair.candidate));
      if (!pair.got_worse()) continue;
      test.fault = verdict.passes() ? "system-out" : "failure";
      test.message = outcome_of(pair.candidate) + "; reached its goal in the baseline";
    }
  for (const FlightRow& row : comparison.missing)
    cases.push_back({row.condition, fmt::format("{}", row.seed), 0, "error",
                     "in the baseline, missing in the candidate"});
  for (const FlightRow& row : comparison.added) cases.push_back(case_of(row));
  return to_junit("gate", cases);
}

}  // namespace understory
