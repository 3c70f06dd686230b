#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// What the program leaves behind: whole or nothing, however it ends.
namespace understory::support {
namespace {

namespace fs = std::filesystem;
using CliOutput = FolderTest;

TEST_F(CliOutput, AnOutputThatCannotBeWrittenIsRefusedBeforeTheWork) {
  const std::string nowhere = (folder.path() / "none" / "file").string();
  expect_refusal("rig long --out " + nowhere + ".svg", "cannot write here");
  expect_refusal("bench --rounds 100000 --json " + nowhere, "cannot write here");
  expect_refusal("gate --baseline a --candidate b --junit " + nowhere, "cannot write here");
#ifdef UNDERSTORY_HAS_SIM
  const std::string endless = "fly forest --set forest.length_m=400 --set forest.intangible=true ";
  expect_refusal(endless + "--row " + nowhere, "cannot write here");
  expect_refusal(endless + "--junit " + nowhere, "cannot write here");
  expect_refusal(endless + "--out /dev/null/run", "cannot write here");
  expect_refusal(endless + "--junit /proc/none", "cannot write here");
#endif
}

TEST_F(CliOutput, APictureGoesThroughALinkToAFullDevice) {
  const fs::path link = folder.path() / "rig.svg";
  fs::create_symlink("/dev/full", link);
  if (geteuid() == 0) {  // who could replace the machine's: one of our own
    fs::remove(link);
    const fs::path full = folder.path() / "full";
    if (std::system(("mknod -m 666 " + full.string() + " c 1 7 && test -c " + full.string()).c_str()) != 0)
      GTEST_SKIP() << "no device may be made here";
    fs::create_symlink(full, link);
  }
  expect_refusal("rig long --out " + link.string(), "No space left on device", 3);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_TRUE(fs::is_character_file(link));
}

#ifdef UNDERSTORY_HAS_SIM
/// Every name below a folder, sorted.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    names.push_back(entry.path().lexically_relative(folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

const std::string short_flight = "fly clear --set forest.length_m=1 --quiet ";
/// Goes on for minutes.
const std::string long_flight =
    "fly forest --set forest.length_m=1000 --set forest.intangible=true --set time_limit_s=600 --quiet ";

TEST_F(CliOutput, StandardOutputIsNoFileToBeReplaced) {
  const fs::path file = folder.path() / "said";
  const ProgramRun flown =
      understory(short_flight + "--row /dev/stdout --junit /dev/stdout > " + file.string());
  EXPECT_EQ(flown.status, 0) << flown.text;
  const std::string said = content_of(file);
  EXPECT_LT(said.find("\"outcome\": \"goal\""), said.find("<testsuites")) << said;
  EXPECT_EQ(names_in(folder.path()).size(), 1u);
}

TEST_F(CliOutput, ARunsFilesMayBeNamedWithinItsFolder) {
  const std::string run = path("run");
  EXPECT_EQ(understory(short_flight + "--out " + run + " --junit " + run + "/junit.xml").status, 0);
  EXPECT_TRUE(fs::exists(folder.path() / "run/junit.xml"));
}

TEST_F(CliOutput, ARunOfAnotherConfigurationIsKeptUnlessForced) {
  const std::string there = "cd " + folder.path().string() + " &&";
  EXPECT_EQ(understory(short_flight, there).status, 0);
  const fs::path run = folder.path() / "runs" / "clear-1000";
  const std::string first = content_of(run / "result.json");
  expect_refusal(short_flight + "--set time_limit_s=2", "another configuration (scenario.yaml): --force", 2,
                 there);
  expect_refusal("record clear --out runs/clear-1000", "holds results already", 2, there);
  EXPECT_EQ(content_of(run / "result.json"), first);
  EXPECT_EQ(understory(short_flight, there).status, 0);  // the same again
  EXPECT_EQ(understory(short_flight + "--force --set forest.length_m=2", there).status, 0);
  EXPECT_NE(content_of(run / "result.json"), first);
}

TEST_F(CliOutput, TwoFlightsDoNotMixInOneFolder) {
  const std::string out = "--out " + path("run");
  // The second starts when the first has begun to write, and the first goes on when the second has ended.
  const std::string first = std::string(UNDERSTORY_BINARY) + " " + short_flight +
                            "--set forest.length_m=200 --set forest.intangible=true " + out +
                            " & p=$!; until test -e " + path(".understory-run.unfinished/scenario.yaml") +
                            "; do sleep 0.01; done; kill -STOP $p;";
  const ProgramRun second =
      understory(short_flight + "--seed 7 " + out + " 2>&1; echo status $?; kill -CONT $p; wait", first);
  expect_part(second.text, "another understory writes there");
  expect_part(second.text, "status 2");
  EXPECT_NE(content_of(folder.path() / "run/scenario.yaml").find("seed: 1000"), std::string::npos);
  EXPECT_NE(content_of(folder.path() / "run/result.json").find("\"seed\": 1000"), std::string::npos);
}

/// Stopped when `event` has come: one line, its status, nothing left but `left`.
void expect_stopped(const std::string& arguments, const std::string& event, const fs::path& folder,
                    const std::vector<std::string>& left = {}) {
  for (const auto& [signal, status] : {std::pair("INT", 130), std::pair("TERM", 143)}) {
    const ProgramRun stopped = understory::support::stopped(arguments, folder, signal, event);
    EXPECT_EQ(stopped.status, status) << arguments << "\n" << stopped.text;
    EXPECT_EQ(std::count(stopped.text.begin(), stopped.text.end(), '\n'), 1) << stopped.text;
    expect_part(stopped.text, "stopped");
    EXPECT_EQ(names_in(folder), left) << arguments;
  }
}

TEST_F(CliOutput, NoCommandWritesIntoAFolderThatAnotherWritesInto) {
  const std::string in_folder = "cd " + folder.path().string() + " && ";
  ASSERT_EQ(understory("record clear --set forest.length_m=1 --quiet --out rec", in_folder).status, 0);
  const std::string campaign = "campaign " UNDERSTORY_SOURCE_DIR "/scenarios/library/campaigns/gate.yaml";
  folder.write("tune.yaml",
               "scenario: clear\nparameters: {autopilot.flight_model.cruise_speed_mps: {from: 9, to: 12}}\n"
               "objective: {maximize: progress}\nsearch: {method: random, trials: 1}\n"
               "over: flights\ntraining: 1\nvalidation: 2\n");
  for (const std::string& command :
       {std::string("detect rec"), std::string("evaluate rec"), campaign, std::string("tune tune.yaml")}) {
    expect_refusal(command + " --out /dev/null/x", "cannot write here", 2, in_folder);
    const std::string locked = in_folder + "mkdir -p out && flock out/.understory ";
    expect_refusal(command + " --out out", "out: another understory writes there at this moment", 2, locked);
  }
  fs::remove(folder.path() / "out/.understory");
  EXPECT_TRUE(fs::is_empty(folder.path() / "out"));
  expect_refusal("evaluate none --out new", "none", 2, in_folder);
  EXPECT_FALSE(fs::exists(folder.path() / "new"));
}

TEST_F(CliOutput, ASignalEndsEveryCommandInOneLineAndLeavesNothing) {
  fs::create_directories(folder.path() / "runs");
  expect_stopped(long_flight + "--video", "ls runs/.understory-*.unfinished/scenario.yaml", folder.path(),
                 {"runs"});
  expect_stopped(long_flight + "--video --out runs/x --row row.json",
                 "ls runs/.understory-x.unfinished/scenario.yaml", folder.path(), {"runs"});
  fs::remove(folder.path() / "runs");
  expect_stopped("record forest --out recording --set forest.length_m=400",
                 "ls -d .understory-recording.unfinished/mav0", folder.path());
  const std::string listens =
      "grep -q 'SigCgt:.*[4567cdef]..[2367abef]$' /proc/$p/status";  // handles both signals; no file tells
  expect_stopped("bench --rounds 100000 --json rows.json", listens, folder.path());
  expect_stopped("bench --closed-loop --flights 50 --json rows.json", listens, folder.path());
}

TEST_F(CliOutput, ASignalStopsACampaignThatGoesOnLater) {
  const std::string file = folder
                               .write("c.yaml",
                                      "scenario: forest\nseeds: 1..3\noverrides: [{name: long, set: "
                                      "{forest.length_m: 400, forest.intangible: true}}]\n")
                               .string();
  const ProgramRun stopped = understory::support::stopped("campaign " + file + " --out results",
                                                          folder.path(), "TERM", "ls results/logs/*.txt");
  EXPECT_EQ(stopped.status, 143);
  expect_part(stopped.text, "stopped with 0 of 3 flights over; --resume goes on\n");
  for (const std::string& name : names_in(folder.path())) expect_no_part(name, "unfinished");
}

TEST_F(CliOutput, ASignalStopsTheRecordersOfAnEvaluation) {
  folder.write(
      "suite.yaml",
      "recordings:\n  - {name: forest, scenario: forest, seeds: 1..2, set: {forest.length_m: 400}}\n");
  expect_stopped("evaluate suite.yaml --jobs 2 --out results",
                 "ls -d results/recordings/.understory-forest-*.unfinished/mav0", folder.path(),
                 {"suite.yaml"});
}

/// Runs `arguments` with `folder` a disk of that size, in a mount namespace of its own.
ProgramRun on_small_disk(const std::string& arguments, const fs::path& folder, const std::string& size,
                         const std::string& afterwards) {
  return understory(arguments + "; echo status $?; " + afterwards + "'",
                    "unshare -m sh -c 'mount -t tmpfs -o size=" + size + " tmpfs " + folder.string() +
                        " && cd " + folder.string() + " && ");
}

bool mounts_disks() {
  return std::system("unshare -m sh -c 'mount -t tmpfs tmpfs /mnt' >/dev/null 2>&1") == 0;
}

TEST_F(CliOutput, AFullDiskIsOneLineAndAFilmThatDoesNotFitLosesNoResult) {
  if (!mounts_disks()) GTEST_SKIP() << "only root may mount a small disk";
  const ProgramRun none = on_small_disk(short_flight + "--out run", folder.path(), "4k", "ls -A");
  expect_part(none.text, "No space left on device\nstatus 3\n");
  const ProgramRun no_film = on_small_disk("fly clear --set forest.length_m=5 --quiet --video --out run",
                                           folder.path(), "16k", "ls -A");
  expect_part(no_film.text, "No space left on device\nstatus 3\n");
  const ProgramRun film = on_small_disk("fly clear --set forest.length_m=10 --quiet --video --out run",
                                        folder.path(), "300k", "ls -A . run");
  expect_part(film.text, "No space left on device\nstatus 3\n");
  expect_part(film.text,
              "run:\n.understory\nestimate.tum\nflight.log\nmap.ply\nobstacles.csv\nresult."
              "json\nscenario.yaml\n");
  expect_no_part(film.text.substr(film.text.find("status 3")), "unfinished");
}

// 60 frames take 6 MB, and a second of the next command's hour 12 MB.
TEST_F(CliOutput, ARecordingThatDoesNotFitSaysWhatItNeedsAndWhatIsFree) {
  if (!mounts_disks()) GTEST_SKIP() << "only root may mount a small disk";
  const std::string record = "record clear --set time_limit_s=0.5 --quiet --out r";
  EXPECT_NE(on_small_disk(record, folder.path(), "20m", "true").text.find("status 0"), std::string::npos);
  const fs::path path = folder.path().string() + ".tum";  // the disk lies over the folder
  std::ofstream(path) << "0 0 0 3 0 0 0 1\n60 9 0 3 0 0 0 1\n";
  const ProgramRun refused = on_small_disk("record clear --path " + path.string() + " --quiet --out r",
                                           folder.path(), "20m", "true");
  for (const char* part :
       {"the recording needs up to 0.7", "GB more (7200 frames", "GB are free there", "status 3"})
    expect_part(refused.text, part);
}

TEST_F(CliOutput, AFolderThatIsADiskOfItsOwnIsWrittenWithin) {
  if (!mounts_disks()) GTEST_SKIP() << "only root may mount a small disk";
  const ProgramRun flown = on_small_disk(short_flight + "--out .", folder.path(), "1m", "ls -A");
  EXPECT_EQ(flown.text,
            "status "
            "0\n.understory\nestimate.tum\nflight.log\nmap.ply\nobstacles.csv\nresult.json\nscenario."
            "yaml\ntrajectory."
            "csv\ntruth.tum\n");
}

#endif

}  // namespace
}  // namespace understory::support
