#include "scenarios/report/table.hpp"

#include <gtest/gtest.h>

#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

TEST(Table, LinesUpForPeopleAndForMarkdown) {
  const Table table{{"a|b", "m²"}, {{"long name", "1"}, {"é", "1000"}}};
  EXPECT_EQ(to_text(table), "a|b          m²\nlong name     1\né          1000\n");
  EXPECT_EQ(to_markdown(table), "| a\\|b | m² |\n|---|---:|\n| long name | 1 |\n| é | 1000 |\n");
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
  const auto refusal = [](const std::string& csv) -> std::string {
    try {
      table_from_csv(csv, "t.csv");
    } catch (const ScenarioError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("a,b\n1,2\n3\n"), "t.csv:3: expected a whole row of 2 values");
  EXPECT_EQ(refusal("a\n\"1\n2\"\n3,4\n"), "t.csv:4: expected a whole row of 1 values");
  for (const char* broken : {"a\n\"1\n", "a\n1\"\n", "a\n\"1\"2\n", "a\n1\"2\"\n"})
    EXPECT_EQ(refusal(broken).find("t.csv:2: expected quotation marks"), 0u) << broken << refusal(broken);
}

}  // namespace
}  // namespace understory
