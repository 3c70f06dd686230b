#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "scenarios/output/result_kinds.hpp"
#include "tests/misuse/misuse_table.hpp"
#include "tests/support/temporary_folder.hpp"

/// Whatever a command does and however it ends, files of a user's in its folder are as they were; and what it
/// said it wrote has reached the disk.
namespace understory::support {
namespace {

namespace fs = std::filesystem;

/// Commands that write into the folder "out", with what stands beside it.
const std::map<std::string, std::string> commands{
    {"fly", "$U fly clear --set forest.length_m=1 --quiet --out out"},
    {"film", "$U fly clear --set forest.length_m=1 --quiet --video --mcap --out out"},
    {"record", "$U record clear --path $F/path.tum --quiet --out out"},
    {"report", "cp -rn $F/run/. out/; $U report out --no-video --quiet"},
    {"mcap", "cp -rn $F/run/. out/; $U mcap out --quiet"},
    {"row", "$U fly clear --set forest.length_m=1 --quiet --row out/of_mine.json"},
    {"detect", "$U detect $F/recording --out out"},
    {"evaluate", "$U evaluate $F/recording --out out"},
    {"campaign", "$U campaign $F/campaign.yaml --out out"},
    {"resume", "cp -rn $F/campaign/. out/; $U campaign $F/campaign.yaml --out out --resume"},
    {"collect", "cp -rn $F/campaign/. out/; $U collect out"},
    {"campaign_page", "cp -rn $F/campaign/. out/; $U report out --quiet"},
    {"tune", "$U tune $F/tune.yaml --out out"},
    {"rig", "$U rig long --out out/of_mine.svg"},
    {"bench", "$U bench --pairs 1 --rounds 1 --json out/of_mine.json"}};

/// Commands that refuse a folder with other files: only there the user's files stand in "out" when they are
/// to be refused, and else beside it.
const std::set<std::string> that_need_a_folder{"fly",      "film",     "record", "detect",
                                               "evaluate", "campaign", "tune"};

/// Names that no command writes, and names that some do.
const std::vector<std::string> neutral{"lock",
                                       ".lock",
                                       "notes.txt",
                                       "thesis.tex",
                                       "a.part",
                                       "report.html.part",
                                       "flight.mcap.part",
                                       "overlays.part/1.png",
                                       "run.part/x",
                                       ".hidden",
                                       "with blank",
                                       "\xc3\xbcml\xc3\xa4ut",
                                       "\xff\xfe",
                                       "sub/of/mine",
                                       ".understory-mine",
                                       ".understory-mine.unfinished",
                                       ".understory-theirs.unfinished/x",
                                       "unfinished"};
const std::vector<std::string> taken{
    "result.json",         "scenario.yaml",        "map.ply",          "report.html",     "flight.mcap",
    "flights.csv",         "summary.md",           "campaign.json",    "best.yaml",       "tune.json",
    "worst/a.png",         "points.csv",           "overlay.mp4",      "tables/mine.csv", "evaluation.json",
    "overlays/000000.png", "conditions/mine.yaml", "flights/mine.json"};

/// Names in the folder of a campaign that was begun are the campaign's.
const std::set<std::string> of_a_campaign{"resume", "collect", "campaign_page"},
    names_of_a_campaign{"report.html", "flights.csv", "summary.md", "campaign.json"};

struct Ending {
  std::string name;
  bool neutral_names = true;  ///< none that a command writes: the command is to succeed
  int signal = 0;             ///< sent after a drawn time
  long long disk_bytes = -1;  ///< then the disk is full
};

void draw_files(const fs::path& folder, const std::string& command, bool neutral_names,
                std::mt19937_64& generator) {
  std::vector<std::string> names = neutral;
  if (!neutral_names) names.insert(names.end(), taken.begin(), taken.end());
  for (const std::string& name : names) {
    if (of_a_campaign.contains(command) && names_of_a_campaign.contains(name)) continue;
    if (generator() % 3 == 0) continue;
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << "mine " << generator();
  }
}

/// Status, or 128 and the signal.
int run(const std::string& command, const fs::path& folder, const Fixtures& fixtures, const Ending& ending,
        std::chrono::milliseconds after) {
  const pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);
    setenv("U", UNDERSTORY_BINARY, 1);
    setenv("F", fixtures.folder().c_str(), 1);
    if (ending.disk_bytes >= 0) {
      setenv("LD_PRELOAD", UNDERSTORY_FAILING_DISK, 1);
      setenv("FAILING_DISK_FOLDER", (folder / "").c_str(), 1);
      setenv("FAILING_DISK_BYTES", std::to_string(ending.disk_bytes).c_str(), 1);
    }
    const std::string script =
        "cd '" + folder.string() + "' && { " + command + "; } >/dev/null 2>'" + folder.string() + ".err'";
    execl("/bin/bash", "bash", "-c", script.c_str(), nullptr);
    _exit(127);
  }
  if (ending.signal != 0) {
    std::this_thread::sleep_for(after);
    kill(-child, ending.signal);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

const ResultKind& kind_named(const std::string& name) {
  for (const ResultKind* kind : {&campaign_results, &tuning_results, &evaluation_results, &detection_results})
    if (kind->name == name) return *kind;
  return flight_results;
}

/// Every file that a command listed in its folder is one of its kind's names, which help and pages show.
void expect_known_names(const fs::path& work) {
  std::ifstream mark(work / "out/.understory");
  std::string line;
  std::getline(mark, line);
  for (std::string word, file; mark >> word >> file;) {
    const std::vector<std::string> known = files_of(work / "out", kind_named(word));
    const bool exists = fs::exists(work / "out" / file);
    EXPECT_TRUE(!exists || std::ranges::find(known, file) != known.end())
        << work << ": " << word << " " << file;
  }
}

class KeptFiles : public testing::TestWithParam<Ending> {};

TEST_P(KeptFiles, AreAsTheyWereAfterEveryCommand) {
  const Ending& ending = GetParam();
  const fs::path folder = fs::path(testing::TempDir()) / ("understory_kept_" + ending.name);
  fs::remove_all(folder);
  fs::create_directories(folder / "fixtures");
  Fixtures fixtures(folder / "fixtures");
  fixtures.make_those_in("$F/run $F/recording $F/campaign $F/tuning");
  std::mt19937_64 generator(20261124);
  for (const auto& [name, command] : commands) {
    const fs::path work = folder / name;
    fs::create_directories(work / "out");
    if (name == "resume" && ending.disk_bytes >= 0) continue;  // the disk's library is none that began it
    const bool needs_a_folder = that_need_a_folder.contains(name);
    draw_files(needs_a_folder && ending.neutral_names ? work : work / "out", name, ending.neutral_names,
               generator);
    const auto before = tree_of(work);
    const int status = run(command, work, fixtures, ending, std::chrono::milliseconds(generator() % 600));
    const std::string said = content_of(work.string() + ".err");
    const auto after = tree_of(work);
    for (const auto& [path, content] : before) {
      ASSERT_TRUE(after.contains(path)) << ending.name << " " << name << ": " << path << " is gone\n" << said;
      EXPECT_EQ(after.at(path), content) << ending.name << " " << name << ": " << path << "\n" << said;
    }
    EXPECT_EQ(said.find("internal fault"), std::string::npos) << said;
    if (ending.signal == SIGKILL) continue;  // what is unfinished then goes with the next run
    for (const auto& [path, content] : after)
      EXPECT_TRUE(before.contains(path) || path.find(".unfinished") == std::string::npos)
          << name << " left " << path;
    if (ending.name == "success") expect_known_names(work);
    if (ending.name == "success" || (needs_a_folder && !ending.neutral_names)) {
      EXPECT_EQ(status, ending.neutral_names ? 0 : 2) << name << "\n" << said;
    }
    if (ending.disk_bytes >= 0) {
      EXPECT_TRUE(status == 3 || (status == 0 && ending.name == "disk_that_fills"))
          << name << " " << status << "\n"
          << said;
    }
  }
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Endings, KeptFiles,
                         testing::Values(Ending{"success"}, Ending{"refusal", false},
                                         Ending{"interrupted", true, SIGINT}, Ending{"killed", true, SIGKILL},
                                         Ending{"full_disk", true, 0, 100},
                                         Ending{"disk_that_fills", true, 0, 9000}),
                         [](const auto& ending) { return ending.param.name; });

/// Files by the names they have at last, and "in FOLDER" for names that changed there: whether each was
/// synced since.
std::map<std::string, bool> synced_by(const fs::path& diary) {
  std::map<std::string, bool> is_synced;
  std::ifstream lines(diary);
  for (std::string word, path; lines >> word;) {
    if (word == "syncfs") {
      for (auto& [file, synced] : is_synced) synced = true;
      continue;
    }
    if (word == "say") continue;
    lines >> path;
    if (word == "write") is_synced[path] = false;
    if (word == "sync") is_synced[fs::is_directory(path) ? "in " + path : path] = true;
    if (word != "rename") continue;
    std::string to;
    lines >> to;
    std::map<std::string, bool> renamed;
    for (const auto& [file, synced] : is_synced) {
      const bool is_moved = file == path || file.starts_with(path + "/");
      renamed[is_moved ? to + file.substr(path.size()) : file] = synced;
    }
    is_synced = renamed;
    if (to.find(".unfinished/") == std::string::npos)
      is_synced["in " + fs::path(to).parent_path().string()] = false;
  }
  std::erase_if(is_synced,
                [](const auto& one) { return one.first.find(".unfinished") != std::string::npos; });
  return is_synced;
}

TEST(KeptFiles, WhatACommandSaysItWroteHasReachedTheDisk) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "fixtures");
  Fixtures fixtures(folder.path() / "fixtures");
  fixtures.make_those_in("$F/run $F/recording $F/campaign");
  for (const char* name : {"fly", "record", "report", "mcap", "detect", "evaluate", "campaign", "collect"}) {
    const fs::path work = folder.path() / name, diary = folder.path() / (std::string(name) + ".diary");
    fs::create_directories(work / "out");
    setenv("FAILING_DISK_DIARY", diary.c_str(), 1);
    const Ending on_that_disk{name, true, 0, 1'000'000'000'000};
    ASSERT_EQ(run(commands.at(name), work, fixtures, on_that_disk, {}), 0)
        << content_of(work.string() + ".err");
    unsetenv("FAILING_DISK_DIARY");
    const std::map<std::string, bool> is_synced = synced_by(diary);
    EXPECT_FALSE(is_synced.empty()) << name;
    for (const auto& [path, synced] : is_synced) {
      const bool says_nothing_of = path.ends_with("/.understory") || path.find("/logs/") != std::string::npos;
      EXPECT_TRUE(synced || says_nothing_of) << name << ": " << path;
    }
  }
}

/// What goes on when the same command is given again; one job, so that names are made in the same order.
const std::map<std::string, std::string> that_go_on{
    {"campaign", "$U campaign c.yaml --out out --jobs 1 --keep-runs --resume"},
    {"tune", "$U tune t.yaml --out out --jobs 1 --resume"},
    {"evaluate", "$U evaluate e.yaml --every 2 --out out --jobs 1"},
    {"record", "$U record clear --path path.tum --set cameras.rate_hz=20 --quiet --out out --force"},
    {"fly", "$U fly s.yaml --quiet --mcap --out out"},
    {"collect", "$U collect out"}};

/// Whether a process still holds a lock below: one that was killed lets go of its memory first, and then of
/// its files.
bool is_locked(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    const int file = open(entry.path().c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const bool is_held = file >= 0 && flock(file, LOCK_EX | LOCK_NB) != 0;
    if (file >= 0) close(file);
    if (is_held) return true;
  }
  return false;
}

/// Runs it, killed at that moment (0: never). Gives how many moments there were.
std::int64_t moments_of(const std::string& command, const fs::path& folder, const Fixtures& fixtures,
                        std::int64_t killed_at, int& status) {
  const std::string calls = folder.string() + ".calls";
  std::ofstream(calls, std::ios::binary) << std::string(16, '\0');
  setenv("FAILING_DISK_CALLS", calls.c_str(), 1);
  setenv("FAILING_DISK_KILL", std::to_string(killed_at).c_str(), 1);
  status = run(command, folder, fixtures, {"", true, 0, 1'000'000'000'000}, {});
  unsetenv("FAILING_DISK_CALLS");
  while (is_locked(folder)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  std::int64_t count = 0;
  std::ifstream(calls, std::ios::binary).read(reinterpret_cast<char*>(&count), sizeof count);
  return count;
}

void begin(const std::string& name, const TemporaryFolder& folder, const Fixtures& fixtures) {
  fs::remove_all(folder.path() / "work");
  folder.write("work/s.yaml",
               "course: clear\ntime_limit_s: 0.5\nforest: {length_m: 1}\nperception: {detector: none}\n");
  folder.write("work/c.yaml", "scenario: s.yaml\nseeds: 1\n");
  folder.write("work/path.tum", "0 0 0 3 0 0 0 1\n0.06 0.6 0 3 0 0 0 1\n");
  folder.write(
      "work/e.yaml",
      "recordings: [{name: a, scenario: clear, seeds: 1, path: path.tum, set: {cameras.rate_hz: 20}}]\n");
  folder.write("work/t.yaml",
               "scenario: s.yaml\nparameters: {autopilot.flight_model.cruise_speed_mps: {from: 9, to: 12}}\n"
               "objective: {maximize: progress}\nsearch: {method: random, trials: 1, sensitivity: 2}\n"
               "over: flights\ntraining: 1\nvalidation: 2\n");
  if (name == "collect")
    fs::copy(fixtures.folder() / "campaign", folder.path() / "work/out", fs::copy_options::recursive);
}

class GoesOn : public testing::TestWithParam<std::string> {};

/// Killed before and behind every call that makes, changes or removes a name, it goes on, and leaves the
/// names and rows of one that nobody disturbed.
TEST_P(GoesOn, WhereverItWasKilled) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "fixtures");
  Fixtures fixtures(folder.path() / "fixtures");
  if (GetParam() == "collect") fixtures.make_those_in("$F/campaign");
  const fs::path work = folder.path() / "work";
  const std::string& command = that_go_on.at(GetParam());
  const int expected_status = GetParam() == "fly" ? 1 : 0;  // it runs out of time
  int status = 0;
  begin(GetParam(), folder, fixtures);
  const std::int64_t moments = moments_of(command, work, fixtures, 0, status);
  ASSERT_EQ(status, expected_status) << content_of(work.string() + ".err");
  ASSERT_GT(moments, 10);
  const auto expected = tree_of(work);
  // All of them take 20 min: every day some of the commands with many, and at night all.
  const bool all = std::getenv("UNDERSTORY_EVERY_MOMENT") != nullptr || moments < 130;
  for (std::int64_t moment = 1; moment <= moments; moment += all ? 1 : 5) {
    begin(GetParam(), folder, fixtures);
    moments_of(command, work, fixtures, moment, status);
    EXPECT_EQ(status, 128 + SIGKILL) << moment;
    moments_of(command, work, fixtures, 0, status);
    ASSERT_EQ(status, expected_status) << moment << ": " << content_of(work.string() + ".err");
    const auto after = tree_of(work);
    for (const auto& [path, content] : after)
      EXPECT_TRUE(expected.contains(path)) << moment << ": " << path << " was left";
    for (const auto& [path, content] : expected) {
      ASSERT_TRUE(after.contains(path)) << moment << ": " << path << " is missing";
      const bool is_rows =
          path.ends_with("flights.csv") || path.ends_with("s.jsonl") || path.ends_with(".png");
      if (is_rows) {
        EXPECT_EQ(after.at(path), content) << moment << ": " << path;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Commands, GoesOn,
                         testing::Values("campaign", "tune", "evaluate", "record", "fly", "collect"),
                         [](const auto& command) { return command.param; });

}  // namespace
}  // namespace understory::support
