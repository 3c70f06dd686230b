#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/misuse/misuse_table.hpp"

/// What hostile and unlucky users do, row by row (tables/*.txt). Nothing here knows the program's wording: a
/// refusal is one line that names file, line and key, has the right status, and leaves everything as it was.
namespace understory::support {
namespace {

namespace fs = std::filesystem;

const fs::path tables = fs::path(UNDERSTORY_SOURCE_DIR) / "tests/misuse/tables";

std::vector<std::string> table_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(tables)) names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

class MisuseTable : public testing::TestWithParam<std::string> {};

TEST_P(MisuseTable, EndsAsItMust) {
  const fs::path folder = fs::path(testing::TempDir()) / ("understory_misuse_" + GetParam());
  fs::remove_all(folder);
  fs::create_directories(folder / "fixtures");
  Fixtures fixtures(folder / "fixtures");
  for (const Misuse& misuse : read_misuses(tables / (GetParam() + ".txt"))) {
    const std::string fault = fault_of(misuse, fixtures, folder / "row");
    EXPECT_EQ(fault, "") << misuse.place;
  }
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Rows, MisuseTable, testing::ValuesIn(table_names()),
                         [](const auto& table) { return table.param; });

TEST(MisuseTables, HoldAtLeast350Rows) {
  std::size_t rows = 0;
  for (const std::string& name : table_names()) rows += read_misuses(tables / (name + ".txt")).size();
  EXPECT_GE(rows, 350u);
}

}  // namespace
}  // namespace understory::support
