#include <gtest/gtest.h>

#include "scenarios/campaign/flight_row.hpp"
#include "tests/support/flight_rows.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// `understory gate` as CI meets it.
namespace understory {
namespace {

using namespace support;
using GateCommand = FolderTest;

/// Writes a campaign's folder: 20 flights, of which the first `collisions` collide.
std::string campaign(const support::TemporaryFolder& folder, const std::string& name,
                     std::uint64_t collisions) {
  std::vector<FlightRow> rows;
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    rows.push_back(
        flown_row("forest", seed, seed < collisions ? "collision" : "goal", seed < collisions ? 30 : 75));
  folder.write(name + "/flights.csv", to_csv(rows));
  return (folder.path() / name).string();
}

TEST_F(GateCommand, EndsWithItsVerdict) {
  const std::string gate = "gate --baseline " + campaign(folder, "before", 0);
  expect_success(gate + " --candidate " + campaign(folder, "same", 0));
  expect_success(gate + " --candidate " + campaign(folder, "one", 1));
  const std::string worse = gate + " --candidate " + campaign(folder, "two", 2);
  const support::Outcome failed = support::understory(worse + " --junit " + path("gate.xml"));
  EXPECT_EQ(failed.status, 1);
  expect_part(failed.text, "worse: forest: seed 0 (collision at 30.0 m), 1 (");
  expect_part(support::content_of(folder.path() / "gate.xml"), "tests=\"21\" failures=\"3\" errors=\"0\"");
  expect_success(worse + " --max-drop 0.1");
}

TEST_F(GateCommand, RefusesWhatMeansNothing) {
  const std::string here = campaign(folder, "here", 0);
  expect_refusal("gate --baseline " + here, "candidate");
  expect_refusal("gate --candidate " + here + " --baseline " + path("gone"), "gone");
  const std::string both = "gate --baseline " + here + " --candidate " + here;
  for (const char* drop : {"nan", "-0.1", "1.1", "5%"})
    expect_refusal(both + " --max-drop " + drop, "--max-drop");
  expect_refusal(both + " --junit " + path("gone/gate.xml"), "gate.xml");
}

}  // namespace
}  // namespace understory
