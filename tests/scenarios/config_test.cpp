#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/field_writer.hpp"
#include "tests/support/text.hpp"

namespace understory {
namespace {

using namespace support;

enum class Colour { red, green };

struct Inner {
  double length_m = 2.5;
  std::vector<double> gains{1, 2};
};

struct Entry {
  Colour colour = Colour::green;
  int count = 5;
  Inner inner;
};

struct Outer {
  bool on = true;
  int count = 3;
  std::uint64_t seed = 7;
  std::string name = "a \"word\": it";
  Colour colour = Colour::red;
  Eigen::Vector3d wind{0.1, 0, -1e-300};
  Inner inner;
  std::vector<Entry> entries;
};

constexpr std::array<std::pair<std::string_view, Colour>, 2> colour_names{
    {{"red", Colour::red}, {"green", Colour::green}}};

template <typename Visitor>
void visit_fields(Visitor& visit, Inner& inner) {
  visit("length_m", inner.length_m, 0.0, 10.0);
  visit("gains", inner.gains, -1.0, 5.0);
}

template <typename Visitor>
void visit_fields(Visitor& visit, Entry& entry) {
  visit("colour", entry.colour, colour_names);
  visit("count", entry.count, 0, 9);
  visit("inner", entry.inner);
}

template <typename Visitor>
void visit_fields(Visitor& visit, Outer& outer) {
  visit("on", outer.on);
  visit("count", outer.count, 0, 9);
  visit("seed", outer.seed, std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max());
  visit("name", outer.name);
  visit("colour", outer.colour, colour_names);
  visit("wind", outer.wind, -5.0, 5.0);
  visit("inner", outer.inner);
  visit("entries", outer.entries);
}

Outer read(const std::string& text) {
  Outer outer;
  read_config(parse_yaml(text, "a.yaml"), outer);
  return outer;
}

std::string refusal(const std::string& text) {
  return refusal_of<ScenarioError>([&] { read(text); });
}

std::string set_refusal(const std::string& assignment) {
  Outer outer;
  return refusal_of<ScenarioError>([&] { read_config(parse_assignment(assignment), outer); });
}

TEST(Config, ReadsEveryKindOfField) {
  const Outer outer = read(
      "on: false\ncount: 9\nseed: 18446744073709551615\nname: x\ncolour: green\n"
      "wind: [1, -2.5, 3e0]\ninner: {length_m: 0, gains: [5]}\n");
  EXPECT_FALSE(outer.on);
  EXPECT_EQ(outer.count, 9);
  EXPECT_EQ(outer.seed, 18446744073709551615u);
  EXPECT_EQ(outer.colour, Colour::green);
  EXPECT_EQ(outer.wind, Eigen::Vector3d(1, -2.5, 3));
  EXPECT_EQ(outer.inner.length_m, 0);
  EXPECT_EQ(outer.inner.gains, std::vector<double>{5});
}

TEST(Config, AbsentKeysKeepTheirDefaults) {
  const Outer outer = read("count: 4\n");
  EXPECT_EQ(outer.count, 4);
  EXPECT_EQ(outer.inner.length_m, 2.5);
}

TEST(Config, RefusesInOneLineWithFileLineKeyAndExpectation) {
  const std::pair<const char*, std::string> cases[] = {
      {"count: 1\ncuont: 2\n", "2: cuont: unknown key (did you mean count?)"},
      {"inner:\n  lenght_m: 2\n", "2: inner.lenght_m: unknown key (did you mean length_m?)"},
      {"zzzzzz: 2\n", "1: zzzzzz: unknown key"},
      {"count: 1\n\ncount: 1\n", "3: count: this key is given twice"},
      {"inner:\n  gains: [1]\n  gains: [1]\n", "3: inner.gains: this key is given twice"},
      {"count: 10\n", "1: count: expected a whole number from 0 to 9, got 10"},
      {"inner: {length_m: far}\n", "1: inner.length_m: expected a number from 0 to 10, got far"},
      {"on: maybe\n", "1: on: expected true or false, got maybe"},
      {"colour: blue\n", "1: colour: expected red | green, got blue"},
      {"wind: [1, 2]\n", "1: wind: expected a list of three numbers [x, y, z], got a list of 2"},
      {"inner: 3\n", "1: inner: expected a group of keys, got 3"},
      {"inner:\n", "1: inner: expected a group of keys, got nothing"},
      // Of a list it names the entry.
      {"entries:\n  - count: 2\n  - count: 2\n    cuont: 3\n",
       "4: entries[1].cuont: unknown key (did you mean count?)"},
      {"entries:\n  - colour: red\n    inner:\n      length_m: 11\n",
       "4: entries[0].inner.length_m: expected a number from 0 to 10, got 11"},
      {"entries:\n  - {count: 1, count: 2}\n", "2: entries[0].count: this key is given twice"},
      {"entries:\n  - 3\n", "2: entries[0]: expected a group of keys, got 3"},
      {"entries: 3\n", "1: entries: expected a list of groups [{...}, ...], got 3"},
      {"entries: {count: 3}\n", "1: entries: expected a list of groups [{...}, ...], got a group of keys"},
      {"entries:\n", "1: entries: expected a list of groups [{...}, ...], got nothing"},
  };
  for (const auto& [text, says] : cases) EXPECT_EQ(refusal(text), "a.yaml:" + says);
}

TEST(Config, RefusesNumbersThatAreNot) {
  for (const char* value : {"1.5", "\"3\"", "-1", "0x3", "3 ", "1e1", "[3]", "", "nan"}) {
    const bool is_plain_three = std::string(value) == "3 ";  // YAML trims
    EXPECT_EQ(refusal("count: " + std::string(value) + "\n") == "", is_plain_three) << value;
  }
  for (const char* value : {"nan", "inf", ".inf", "\"1\"", "1,5", "1m"}) {
    EXPECT_NE(refusal("inner: {length_m: " + std::string(value) + "}\n"), "") << value;
  }
}

TEST(Config, RefusesBrokenOrEmptyYaml) {
  EXPECT_EQ(refusal("a: [1\nb: 2\n").substr(0, 9), "a.yaml:1:");
  EXPECT_EQ(refusal(""), "a.yaml:1: must be one YAML document with keys and values");
  EXPECT_EQ(refusal("just words\n"), "a.yaml:1: must be one YAML document with keys and values");
  EXPECT_EQ(refusal("on: true\n---\non: true\n"), "a.yaml:2: must be one YAML document with keys and values");
  EXPECT_EQ(refusal(", w"), "a.yaml:1: must be one YAML document with keys and values");
  EXPECT_THROW(parse_config_file("/proc/nowhere/to/be.yaml"), ScenarioError);
  EXPECT_THROW(parse_config_file("/"), ScenarioError);
}

TEST(Config, AssignmentsPassTheSameChecks) {
  Outer outer;
  read_config(parse_assignment("inner.length_m=4"), outer);
  read_config(parse_assignment("wind=[1,2,3]"), outer);
  EXPECT_EQ(outer.inner.length_m, 4);
  EXPECT_EQ(outer.wind, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(set_refusal("inner.length_m=40"),
            "--set inner.length_m=40: inner.length_m: expected a number from 0 to 10, got 40");
  EXPECT_EQ(set_refusal("iner.length_m=4"), "--set iner.length_m=4: iner: unknown key (did you mean inner?)");
  EXPECT_EQ(set_refusal("wind=[1,2,30]"),
            "--set wind=[1,2,30]: wind: expected a number from -5 to 5, got 30");
  EXPECT_NE(set_refusal("count"), "");
  EXPECT_NE(set_refusal("=3"), "");
  EXPECT_NE(set_refusal("name="), "");
  EXPECT_NE(set_refusal("inner..length_m=3"), "");
  EXPECT_NE(set_refusal("count=[1"), "");
}

TEST(Config, ReadsAListOfGroups) {
  const Outer outer = read("entries:\n  - count: 2\n    inner: {length_m: 7}\n  - {colour: red}\n");
  ASSERT_EQ(outer.entries.size(), 2u);
  EXPECT_EQ(outer.entries[0].count, 2);
  EXPECT_EQ(outer.entries[0].colour, Colour::green);  // the entry's own default
  EXPECT_EQ(outer.entries[0].inner.length_m, 7);
  EXPECT_EQ(outer.entries[1].colour, Colour::red);
  EXPECT_EQ(outer.entries[1].count, 5);
  EXPECT_TRUE(read("entries: []\n").entries.empty());
}

TEST(Config, AnAssignmentReplacesAListOfGroups) {
  Outer outer;
  outer.entries.resize(3);
  outer.entries[0].count = 1;
  read_config(parse_assignment("entries=[{colour: red}, {inner: {length_m: 2.5}}]"), outer);
  ASSERT_EQ(outer.entries.size(), 2u);
  EXPECT_EQ(outer.entries[0].count, 5);  // nothing of the list before it
  EXPECT_EQ(outer.entries[1].inner.length_m, 2.5);
  EXPECT_EQ(set_refusal("entries=[{count: 10}]"),
            "--set entries=[{count: 10}]: entries[0].count: expected a whole number from 0 to 9, got 10");
}

TEST(Config, FindsWhereAKeyOfAListWasGiven) {
  const std::vector<ConfigNode> sources{
      parse_yaml("on: true\nentries:\n  - count: 1\n  - colour: red\n    count: 2\n", "a.yaml")};
  EXPECT_EQ(origin_of(sources, "entries[1].count"), "a.yaml:5");
  EXPECT_EQ(origin_of(sources, "entries[0].count"), "a.yaml:3");
  EXPECT_EQ(origin_of(sources, "entries[0].colour"), "");
  EXPECT_EQ(origin_of(sources, "entries[2].count"), "");
  EXPECT_EQ(origin_of(sources, "on"), "a.yaml:1");
}

TEST(Config, WritingAndReadingAgainIsExact) {
  Outer outer;
  outer.inner.length_m = 0.1 + 0.2;
  outer.inner.gains = {1.0 / 3, -0.0, 4.9406564584124654e-324};
  outer.seed = (std::uint64_t{1} << 63) + 1;
  outer.colour = Colour::green;
  outer.on = false;
  outer.entries.resize(2);
  outer.entries[1].colour = Colour::red;
  outer.entries[1].inner.gains = {0.25};
  const std::string text = write_config(outer);
  const Outer again = read(text);
  EXPECT_EQ(again.inner.length_m, outer.inner.length_m);
  EXPECT_EQ(again.inner.gains, outer.inner.gains);
  EXPECT_EQ(again.seed, outer.seed);
  EXPECT_EQ(again.name, outer.name);
  EXPECT_EQ(again.wind, outer.wind);
  EXPECT_EQ(again.colour, outer.colour);
  EXPECT_EQ(again.on, outer.on);
  ASSERT_EQ(again.entries.size(), 2u);
  EXPECT_EQ(again.entries[1].colour, Colour::red);
  EXPECT_EQ(again.entries[1].inner.gains, std::vector<double>{0.25});
  expect_part(text, "entries:\n  - colour: green\n    count: 5\n    inner:\n      length_m: 2.5\n");
  expect_part(write_config(Outer{}), "entries: []\n");
  EXPECT_EQ(write_config(again), text);
  EXPECT_EQ(text.substr(0, 10), "on: false\n");
}

}  // namespace
}  // namespace understory
