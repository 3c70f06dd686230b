#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// Campaigns as they are run and as they break: flights of a clear field by the blind, a fraction of a second
/// each.
namespace understory::support {
namespace {

namespace fs = std::filesystem;

class CampaignRun : public testing::Test {
 protected:
  const understory::support::TemporaryFolder temporary;
  const fs::path& path = temporary.path();

  std::string file(const std::string& name, const std::string& text) const {
    return temporary.write(name, text).string();
  }
  std::string blind(const std::string& more) const {
    return file("blind.yaml",
                "scenario: clear\noverrides: [{name: blind, set: {perception.detector: none}}]\n" + more);
  }
  std::string text(const fs::path& name) const { return content_of(path / name); }
  std::string out(const std::string& name) const { return " --out " + (path / name).string(); }

  /// The campaign in the background.
  pid_t start(const std::string& campaign, const std::string& folder) const {
    const std::string results = (path / folder).string();
    const pid_t child = fork();
    if (child != 0) return child;
    const int nothing = open("/dev/null", O_RDWR);
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
    execl(UNDERSTORY_BINARY, "understory", "campaign", campaign.c_str(), "--out", results.c_str(), "--jobs",
          "2", "--resume", nullptr);
    _exit(127);
  }
  /// Empty where the process has ended in the meantime.
  static std::string command_of(const fs::path& process) try {
    return content_of(process / "cmdline");
  } catch (const std::exception&) {
    return "";
  }
  /// The process that flies `id`, once it does.
  pid_t process_of(const std::string& id) const {  // ours: other tests fly flights of that name beside us
    while (true) {
      for (const auto& process : fs::directory_iterator("/proc")) {
        const std::string command = command_of(process.path());
        if (command.find(path.string()) != std::string::npos &&
            command.find("/" + id + ".json") != std::string::npos)
          return std::stoi(process.path().filename().string());
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
};

int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Each flight makes its log before all else: there it is struck.
TEST_F(CampaignRun, ACrashAHangAndAKillCostOneFlightEach) {
  const std::string disk =
      "LD_PRELOAD=" UNDERSTORY_FAILING_DISK " FAILING_DISK_FOLDER=" + path.string() + "/";
  expect_success("campaign " + blind("seeds: 1..6\n") + out("undisturbed"));
  double slowest_s = 0;
  std::istringstream costs(text("undisturbed/costs.csv"));
  std::string line;
  std::getline(costs, line);
  while (std::getline(costs, line))
    slowest_s = std::max(slowest_s, std::stod(line.substr(line.find(',') + 1)));
  const std::string campaign = blind("seeds: 1..6\ntimeout_s: " + std::to_string(3 + 50 * slowest_s) + "\n");
  EXPECT_EQ(understory("campaign " + campaign + out("results") + " --jobs 2",
                       disk + " FAILING_DISK_SIGNALS='-1.txt 11 -3.txt 9 -5.txt 19'")
                .status,
            1);
  const std::string rows = text("results/flights.csv");
  expect_part(rows, "clear-blind-1,clear-blind,1,crashed,signal 11 (Segmentation fault),");
  expect_part(rows, "clear-blind-3,clear-blind,3,killed,signal 9 (Killed),");
  expect_part(rows, "clear-blind-5,clear-blind,5,hung,took longer than timeout_s = ");
  for (const char* seed : {"2", "4", "6"})
    expect_part(rows, std::string("clear-blind-") + seed + ",clear-blind," + seed + ",flown,,goal,");
  // And flown again they are as if nothing had been.
  expect_success("campaign " + campaign + out("results") + " --resume", disk);
  EXPECT_EQ(text("results/flights.csv"), text("undisturbed/flights.csv"));
}

TEST_F(CampaignRun, FlightsDieWithTheirCampaign) {
  const std::string slow = file("slow.yaml",
                                "scenario: clear\nseeds: 1\ntimeout_s: 86400\noverrides: [{name: slow, set: "
                                "{forest.length_m: 900, time_limit_s: 600}}]\n");
  const pid_t child = start(slow, "results");
  const pid_t flight = process_of("clear-slow-1");
  kill(flight, SIGSTOP);
  kill(child, SIGKILL);
  wait_for(child);
  while (fs::exists("/proc/" + std::to_string(flight) + "/exe"))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

TEST_F(CampaignRun, PrintedTasksGiveTheSameRows) {
  const std::string campaign = blind("seeds: 1..3\n");
  expect_success("campaign " + campaign + out("here"));
  const ProgramRun tasks = expect_success("campaign " + campaign + out("there") + " --print-tasks");
  EXPECT_EQ(std::count(tasks.text.begin(), tasks.text.end(), '\n'), 3);
  EXPECT_EQ(understory("collect " + (path / "there").string()).status, 1);  // nothing flown yet
  // Twice, and from another folder: a task is idempotent and says all it needs.
  const std::string script = file("tasks.sh", tasks.text + tasks.text);
  ASSERT_EQ(std::system(("cd / && sh " + script).c_str()), 0);
  expect_success("collect " + (path / "there").string());
  EXPECT_EQ(text("there/flights.csv"), text("here/flights.csv"));
}

TEST_F(CampaignRun, WritesJunitOfFlightsAndCampaigns) {
  const std::string of_campaign = (path / "campaign.xml").string(),
                    of_flight = (path / "flight.xml").string();
  expect_success("campaign " + blind("seeds: 1..2\n") + out("results") + " --junit " + of_campaign);
  expect_part(text("campaign.xml"), "tests=\"2\" failures=\"0\" errors=\"0\"");
  const std::string short_lived = "fly clear --seed 7 --set time_limit_s=1 --out " + (path / "run").string();
  ASSERT_EQ(understory(short_lived + " --junit " + of_flight).status, 1);
  expect_part(text("flight.xml"), "tests=\"1\" failures=\"1\" errors=\"0\"");
  expect_part(text("flight.xml"), "classname=\"clear\" name=\"7\"");
}

TEST_F(CampaignRun, RefusesFoldersThatAreNotItsOwn) {
  const std::string campaign = blind("seeds: 1\n");
  expect_success("campaign " + campaign + out("results"));
  expect_refusal("campaign " + campaign + out("results"),
                 "holds a campaign already: --resume goes on with it");
  expect_refusal("campaign " + blind("seeds: 1..2\n") + out("results") + " --resume", "seeds changed");
  expect_refusal("campaign " + campaign + " --out /proc/nowhere", "cannot write here");
  expect_refusal("campaign /proc/nowhere.yaml", "cannot read this");
  expect_refusal("collect " + path.string(), "not a folder of a campaign");
  expect_refusal(
      "campaign " + file("rig.yaml", "scenario: clear\nseeds: 1\ngrid: {rig: [monocle]}\n") + out("rig"),
      "condition clear-rig=monocle");
}

/// Two scenes as a data set: a list, a licence, and checksums that coreutils confirm.
TEST_F(CampaignRun, RecordsADataSet) {
  const std::string campaign = file("two.yaml", "scenario: forest\nseeds: [1003, 1004]\n");
  const std::string options =
      " --set time_limit_s=0.6 --set cameras.rate_hz=60 --record kitti --every 10" + out("set");
  expect_success("campaign " + campaign + options);
  const std::string scenes = text("set/scenes.csv");
  expect_part(scenes, "folder,condition,seed,pairs,outcome\nruns/");
  EXPECT_EQ(std::ranges::count(scenes, '\n'), 3);
  expect_part(text("set/LICENSE.txt"), "CC0-1.0");
  const std::string sums = text("set/SHA256SUMS");
  for (const char* name :
       {"disp_occ/000000_10.png", "training/calib/000000.txt", "poses.txt", "scenes.csv", "conditions/"})
    expect_part(sums, name);
  EXPECT_EQ(
      std::system(("cd " + (path / "set").string() + " && sha256sum --check --quiet SHA256SUMS").c_str()), 0);
  expect_success("campaign " + campaign + options +
                 " --resume");  // nothing is flown again, nothing is refused
  // Whoever goes on without saying so records, too, and nothing else.
  fs::remove(path / "set/scenes.csv");
  expect_success("campaign " + (path / "set").string() + " --resume --seeds 1005");
  EXPECT_EQ(std::ranges::count(text("set/scenes.csv"), '\n'), 4);
  expect_refusal("campaign " + (path / "set").string() + " --resume --record kitti --every 20",
                 "--record or --every changed");
  expect_refusal("campaign " + campaign + " --every 20" + out("x"), "--every requires --record");
  expect_part(understory("campaign " + campaign + " --record kitti --print-tasks" + out("tasks")).text,
              "'--record' 'kitti' '--every' '1'");
  expect_refusal("campaign " + campaign + " --record png" + out("x"), "--record");
}

}  // namespace
}  // namespace understory::support
