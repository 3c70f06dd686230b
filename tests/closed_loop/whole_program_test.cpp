#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// Every large part of the program once, briefly: what the sanitizers look at (preset asan_sim).
namespace understory::support {
namespace {

namespace fs = std::filesystem;

class WholeProgram : public testing::Test {
 protected:
  /// Runs a command that must end with `status` and leave these files below the test's folder.
  void run(const std::string& arguments, const std::vector<std::string>& files, int status = 0) const {
    const ProgramRun outcome = understory(arguments, "cd " + folder.path().string() + " &&");
    EXPECT_EQ(outcome.status, status) << arguments << "\n" << outcome.text;
    for (const std::string& file : files) {
      std::error_code none;
      EXPECT_GT(fs::file_size(folder.path() / file, none), 0u) << arguments << ": " << file;
    }
  }

  const TemporaryFolder folder;
};

/// Long enough to meet the first trees; time is over then (status 1).
const std::string brief = " --set time_limit_s=2.2";

TEST_F(WholeProgram, FliesAndFilms) {
  run("fly dense --seed 1001 --report --mcap --out flight" + brief,
      {"flight/result.json", "flight/scenario.yaml", "flight/trajectory.csv", "flight/flight.mp4",
       "flight/report.html", "flight/flight.mcap"},
      1);
  run("fly rough_sensors --renderer egl --out egl --set time_limit_s=0.8", {"egl/result.json"}, 1);
}

TEST_F(WholeProgram, RecordsDetectsAndEvaluates) {
  run("record forest --walk=5 --seed 1007 --out recorded --set time_limit_s=1 --set cameras.rate_hz=10",
      {"recorded/mav0/cam0/data.csv", "recorded/mav0/depth0/data.csv"});
  run("detect recorded --out detected", {"detected/points.csv"});
  run("evaluate recorded --jobs 1 --out evaluated", {"evaluated/evaluation.json", "evaluated/summary.md"});
  run("record dense --seed 1001 --out flown" + brief, {"flown/mav0/imu0/data.csv"});
}

TEST_F(WholeProgram, RunsACampaignOfTwoAndComparesIt) {
  folder.write("two.yaml", R"(
scenario: forest
seeds: 1000..1001
overrides: [{name: brief, set: {time_limit_s: 0.8}}]
)");
  run("campaign two.yaml --jobs 2 --out two --junit two.xml",
      {"two/flights.csv", "two/summary.md", "two.xml"});
  run("gate --baseline two --candidate two", {});
  run("report two --baseline two", {"two/report.html"});
}

TEST_F(WholeProgram, Tunes) {
  folder.write("brief.yaml",
               "course: clear\ntime_limit_s: 0.5\nforest: {length_m: 10}\ncameras: {rate_hz: 10}\n");
  folder.write("tune.yaml", R"(
scenario: brief.yaml
parameters: {autopilot.flight_model.cruise_speed_mps: {from: 9, to: 12}}
objective: {maximize: progress}
search: {method: cma_es, trials: 2}
over: flights
training: 1000
validation: 1001
)");
  run("tune tune.yaml --jobs 1 --out tuned", {"tuned/tune.json", "tuned/summary.md"});
}

}  // namespace
}  // namespace understory::support
