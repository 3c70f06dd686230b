#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>

#include "scenarios/output/file_output.hpp"
#include "scenarios/output/output_folder.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

/// How results get their names: whole, one program at a time, nothing of anybody else's lost.
namespace understory {
namespace {

namespace fs = std::filesystem;
using namespace support;
using Output = FolderTest;
using OutputFolderTest = FolderTest;

TEST_F(Output, AFileIsReplacedWholeWithItsModeAndNothingIsLeftBeside) {
  const fs::path file = folder.write("a.txt", "former");
  chmod(file.c_str(), 0640);
  write_whole_file(file, "new");
  EXPECT_EQ(content_of(file), "new");
  struct stat status {};
  ASSERT_EQ(stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST_F(Output, ALinkStaysOneAndWhatItLeadsToIsReplaced) {
  fs::create_directories(folder.path() / "far");
  const fs::path target = folder.write("far/target", "former");
  fs::create_symlink("far/target", folder.path() / "link");
  fs::create_symlink("link", folder.path() / "link_to_link");
  fs::create_symlink("far/none_yet", folder.path() / "dangling");
  write_whole_file(folder.path() / "link_to_link", "new");
  write_whole_file(folder.path() / "dangling", "made");
  EXPECT_EQ(content_of(target), "new");
  EXPECT_EQ(content_of(folder.path() / "far/none_yet"), "made");
  for (const char* link : {"link", "link_to_link", "dangling"})
    EXPECT_TRUE(fs::is_symlink(folder.path() / link)) << link;
}

TEST_F(Output, AFifoAndADeviceAreWrittenThrough) {
  const fs::path fifo = folder.path() / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  const int reader = open(fifo.c_str(), O_RDONLY | O_NONBLOCK);
  require_writable(fifo);
  write_whole_file(fifo, "through");
  char text[16] = "";
  EXPECT_EQ(read(reader, text, sizeof text), 7);
  EXPECT_EQ(std::string(text), "through");
  close(reader);
  EXPECT_TRUE(fs::is_fifo(fifo));

  // A /dev/full of our own, so that a fault does not harm the machine's: who may not make one may not replace
  // that one.
  fs::path full = folder.path() / "full";
  if (mknod(full.c_str(), S_IFCHR | 0666, makedev(1, 7)) != 0 || access(full.c_str(), W_OK) != 0)
    full = "/dev/full";
  EXPECT_THROW(write_whole_file(full, "lost"), MachineError);
  EXPECT_TRUE(fs::is_character_file(full));
}

TEST_F(Output, WhatCannotBeWrittenIsKnownBefore) {
  const fs::path file = folder.write("file", "");
  require_writable("");  // no output at all
  require_writable(folder.path() / "new");
  EXPECT_FALSE(fs::exists(folder.path() / "new"));
  require_writable("/dev/null");
  require_writable("/dev/stdout");
  EXPECT_THROW(require_writable(folder.path() / "none" / "file"), ScenarioError);
  EXPECT_THROW(require_writable(file / "below"), ScenarioError);
  EXPECT_THROW(require_writable(folder.path()), ScenarioError);
  EXPECT_THROW(require_writable("/dev/fd/999"), ScenarioError);
  fs::create_symlink("circle", folder.path() / "circle");
  EXPECT_THROW(require_writable(folder.path() / "circle"), ScenarioError);
  chmod(file.c_str(), 0400);
  if (geteuid() != 0) {  // root may write everywhere
    EXPECT_THROW(require_writable(file), ScenarioError);
  }
}

TEST_F(Output, AnUnwritableFolderIsBadInput) {
  const fs::path file = folder.write("file", "in the way");
  EXPECT_THROW(prepare_output_folder(file / "runs"), ScenarioError);
  EXPECT_THROW(prepare_output_folder(file), ScenarioError);
  EXPECT_THROW(prepare_output_folder("/proc/runs"), ScenarioError);
  EXPECT_THROW(write_whole_file(folder.path() / "none" / "a.txt", "x"), ScenarioError);
  prepare_output_folder(folder.path() / "new" / "runs");
  EXPECT_TRUE(fs::is_empty(folder.path() / "new" / "runs"));
}

/// A run of that configuration, as a command leaves it.
void run_into(const fs::path& folder, const std::string& configuration, Replace replace = Replace::same,
              bool films = false) {
  OutputFolder output(folder, flight_results, configuration, replace);
  write_whole_file(output.path() / "result.json", configuration + "'s result");
  if (films) write_whole_file(output.path() / "flight.mp4", "moving");
  fs::create_directories(output.path() / "mav0/cam0/data");
  write_whole_file(output.path() / "mav0/cam0/data/0.png", "still");
  output.finish();
}

TEST_F(OutputFolderTest, BearsItsNameOnlyWhenItIsWhole) {
  const fs::path run = folder.path() / "runs" / "a-1";
  {
    OutputFolder broken_off(run, flight_results, "a", Replace::same);
    write_whole_file(broken_off.path() / "result.json", "half");
    EXPECT_FALSE(fs::exists(run));
  }
  EXPECT_FALSE(fs::exists(folder.path() / "runs"));
  run_into(run, "a", Replace::same, true);
  EXPECT_EQ(content_of(run / "scenario.yaml"), "a");
  EXPECT_EQ(std::distance(fs::directory_iterator(run), {}), 5);  // and the list of them
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "runs"), {}), 1);
}

TEST_F(OutputFolderTest, TheSameAgainReplacesAllThatWasThere) {
  const fs::path run = folder.path() / "a-1";
  run_into(run, "a", Replace::same, true);
  folder.write("a-1/report.html", "added");
  FolderMark(run, flight_results, run).add({"report.html"});
  {
    OutputFolder again(run, flight_results, "a", Replace::same);
    EXPECT_TRUE(fs::exists(run / "flight.mp4")) << "the former run must stand until the new one is whole";
  }
  EXPECT_TRUE(fs::exists(run / "flight.mp4"));
  run_into(run, "a");
  for (const char* former : {"flight.mp4", "report.html"})
    EXPECT_FALSE(fs::exists(run / former)) << "must not pass for the new run's";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
  folder.write("a-1/flight.mp4", "mine");
  EXPECT_NE(refusal_of<ScenarioError>([&] { run_into(run, "a"); }), "") << "it is listed no more";
}

/// In the folder, below it, and in one of its own; before the flight and during it.
TEST_F(OutputFolderTest, AUsersFileInItIsARefusalAndStays) {
  const fs::path run = folder.path() / "a-1";
  for (const char* mine : {"notes.txt", "result.json", "mav0/cam0/data/holiday.jpg", "sub/of/mine"}) {
    SCOPED_TRACE(mine);
    fs::remove_all(run);
    folder.write(fs::path("a-1") / mine, "mine");
    expect_part(refusal_of<ScenarioError>([&] { run_into(run, "a", Replace::anything); }), mine);
    fs::remove_all(run);
    if (mine != std::string("result.json")) {
      run_into(run, "a");
      folder.write(fs::path("a-1") / mine, "mine");
      expect_part(refusal_of<ScenarioError>([&] { run_into(run, "a", Replace::anything); }), mine);
      EXPECT_EQ(content_of(run / "result.json"), "a's result");
    }
    for (const bool had_run : {false, true}) {
      fs::remove_all(run);
      if (had_run) run_into(run, "a");
      OutputFolder meanwhile(run, flight_results, "a", Replace::anything);
      folder.write(fs::path("a-1") / mine, "mine");
      if (had_run && mine == std::string("result.json")) continue;  // it is the run's
      expect_part(refusal_of<ScenarioError>([&] { meanwhile.finish(); }), mine);
    }
    EXPECT_EQ(content_of(run / mine), "mine");
  }
}

TEST_F(OutputFolderTest, ResultsOfTheirOwnBelowStay) {
  const fs::path evaluation = folder.path() / "evaluation";
  run_into(evaluation / "recordings" / "a", "a");
  for (const char* text : {"first", "second"}) {
    OutputFolder output(evaluation, evaluation_results, "", Replace::anything);
    write_whole_file(output.path() / "summary.md", text);
    output.finish();
    EXPECT_EQ(content_of(evaluation / "summary.md"), text);
  }
  EXPECT_EQ(content_of(evaluation / "recordings/a/result.json"), "a's result");
}

TEST_F(OutputFolderTest, OneKindOfResultsIsInAFolder) {
  run_into(folder.path() / "a", "a");
  const fs::path run = folder.path() / "a";
  expect_part(refusal_of<ScenarioError>([&] { FolderMark(run, campaign_results, run); }),
              "results of another kind (flight)");
  expect_part(refusal_of<ScenarioError>([&] { OutputFolder(run, detection_results, "", Replace::anything); }),
              "results of another kind (flight)");
}

TEST_F(OutputFolderTest, ResultsThatGrowGoOnWithoutTheirHiddenFile) {
  const fs::path campaign = folder.path() / "c";
  folder.write("c/campaign.json", "{}");
  folder.write("c/summary.md", "ours");
  folder.write("c/notes.txt", "mine");
  {
    FolderMark copied(campaign, campaign_results, campaign);
    EXPECT_TRUE(copied.goes_on(true));
    EXPECT_TRUE(copied.files().contains("summary.md"));
    EXPECT_FALSE(copied.files().contains("notes.txt"));
    expect_part(refusal_of<ScenarioError>([&] { copied.goes_on(false); }),
                "holds a campaign already: --resume");
  }
  fs::remove_all(campaign);
  folder.write("c/notes.txt", "mine");
  expect_part(
      refusal_of<ScenarioError>([&] { FolderMark(campaign, campaign_results, campaign).goes_on(true); }),
      "c/notes.txt");
  EXPECT_EQ(std::distance(fs::directory_iterator(campaign), {}), 1);
}

TEST_F(OutputFolderTest, AnotherConfigurationIsKeptUnlessForced) {
  const fs::path run = folder.path() / "a-1";
  run_into(run, "a");
  expect_part(refusal_of<ScenarioError>([&] { run_into(run, "b"); }),
              "another configuration (scenario.yaml): --force");
  expect_part(refusal_of<ScenarioError>([&] { run_into(run, "a", Replace::nothing); }),
              "holds results already");
  EXPECT_EQ(content_of(run / "result.json"), "a's result");
  run_into(run, "b", Replace::anything);
  EXPECT_EQ(content_of(run / "result.json"), "b's result");
  EXPECT_EQ(content_of(run / "scenario.yaml"), "b");
}

TEST_F(OutputFolderTest, WhatStandsBesideIsNeverReplaced) {
  folder.write("new.part/thesis.tex", "precious");
  run_into(folder.path() / "new", "a");
  EXPECT_EQ(content_of(folder.path() / "new.part/thesis.tex"), "precious");
  EXPECT_NE(refusal_of<ScenarioError>([&] { run_into(folder.write("file", ""), "a"); }), "");
}

TEST_F(OutputFolderTest, OneProgramAtATimeWritesIntoAFolder) {
  for (const bool exists : {false, true}) {
    SCOPED_TRACE(exists);
    const fs::path run = folder.path() / "a-1";
    OutputFolder first(run, flight_results, "a", Replace::same);
    expect_part(refusal_of<ScenarioError>([&] { run_into(run, "a"); }), "another understory writes there");
    EXPECT_TRUE(fs::exists(first.path() / "scenario.yaml"));
    first.finish();
  }
}

TEST_F(OutputFolderTest, AMarkThatListsNothingLeavesNothingBehind) {
  const fs::path fresh = folder.path() / "new";
  { const FolderMark mark(fresh, flight_results, fresh); }
  EXPECT_FALSE(fs::exists(fresh));
  fs::create_directory(fresh);
  { const FolderMark mark(fresh, flight_results, fresh); }
  EXPECT_TRUE(fs::is_empty(fresh));
}

TEST_F(OutputFolderTest, IsMadeWhileAnotherProgramClearsTheFolderAbove) {
  const fs::path above = folder.path();
  const pid_t child = fork();
  if (child == 0)
    for (alarm(60);;) clear_unfinished(above);
  for (int i = 0; i < 300; ++i)
    EXPECT_NO_THROW(UnfinishedFolder(above / "one", flight_results, above, false));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

TEST_F(OutputFolderTest, WhatAKilledProgramLeftIsClearedAway) {
  const fs::path run = folder.path() / "a-1";
  if (const pid_t child = fork(); child == 0) {
    const OutputFolder broken_off(run, flight_results, "b", Replace::same);
    write_whole_file(broken_off.path() / "flight.mp4", "half");
    _exit(0);  // as a kill would: nothing is cleared away
  } else {
    waitpid(child, nullptr, 0);
  }
  EXPECT_FALSE(fs::is_empty(folder.path()));
  run_into(run, "a");
  EXPECT_FALSE(fs::exists(run / "flight.mp4"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

/// By the part of its name that the pages have in full: "worst" of "worst/*.png".
TEST(ResultKinds, PagesNameEveryFile) {
  const std::map<const ResultKind*, std::vector<const char*>> pages{
      {&flight_results, {"scenarios", "record", "viewers"}},
      {&campaign_results, {"campaigns"}},
      {&tuning_results, {"tuning"}},
      {&evaluation_results, {"evaluate"}},
      {&detection_results, {"detect"}}};
  for (const auto& [kind, names] : pages) {
    std::string text;
    for (const char* name : names)
      text += content_of(fs::path(UNDERSTORY_SOURCE_DIR) / "docs" / (name + std::string(".md")));
    for (const std::string& pattern : kind->patterns)
      EXPECT_NE(text.find(pattern.substr(0, pattern.find_first_of("/*"))), std::string::npos)
          << kind->name << ": " << pattern;
  }
}

TEST_F(OutputFolderTest, FollowsALinkAndKeepsIt) {
  fs::create_directory_symlink("far", folder.path() / "link");
  run_into(folder.path() / "link", "a");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(content_of(folder.path() / "far/result.json"), "a's result");
  run_into(folder.path() / "link/", "a");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
}

}  // namespace
}  // namespace understory
