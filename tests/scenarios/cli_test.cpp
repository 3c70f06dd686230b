#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

/// The program as people and CI meet it: exit statuses and one-line messages.
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;
  std::string text;
};

/// `before`: environment variables or a change of folder.
Outcome understory(const std::string& arguments, const std::string& before = "") {
  FILE* pipe =
      popen((before + " " + std::string(UNDERSTORY_BINARY) + " " + arguments + " 2>&1").c_str(), "r");
  Outcome outcome;
  std::array<char, 4096> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) outcome.text += buffer.data();
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

void expect_refusal(const std::string& arguments, const std::string& part, int status = 2,
                    const std::string& before = "") {
  const Outcome outcome = understory(arguments, before);
  EXPECT_EQ(outcome.status, status) << arguments;
  EXPECT_NE(outcome.text.find(part), std::string::npos) << outcome.text;
  EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
}

TEST(Cli, HelpAndVersionSucceed) {
  EXPECT_EQ(understory("--help").status, 0);
  EXPECT_EQ(understory("fly --help").status, 0);
  EXPECT_EQ(understory("--version").status, 0);
}

TEST(Cli, WrongArgumentsAreBadInput) {
  expect_refusal("", "subcommand");
  expect_refusal("soar", "subcommand");
  expect_refusal("fly", "scenario");
}

#ifdef UNDERSTORY_HAS_SIM

struct Folder {
  fs::path path =
      fs::path(testing::TempDir()) /
      ("understory_cli_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  Folder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
};

TEST(Cli, BadScenariosAreNamedByFileLineAndKey) {
  const Folder folder;
  expect_refusal("fly nowhere", "clear, dense, forest, goalposts, paper");
  expect_refusal("fly " + folder.file("a.yaml", "name: a\nforest:\n  lenght_m: 3\n"),
                 "a.yaml:3: forest.lenght_m");
  expect_refusal("fly " + folder.file("b.yaml", "name: [\n"), "b.yaml:");
  expect_refusal("fly clear --set forest.length_m=-1", "--set forest.length_m=-1: forest.length_m: expected");
  expect_refusal("fly " + folder.file("c.yaml", ""), "c.yaml:1: expected one YAML document");
  expect_refusal("fly " + folder.file("d.yaml", "forest: &again [*again]\n"),
                 "d.yaml:1: forest: expected at most");
  expect_refusal("fly " + folder.file("e.yaml", "name: a/b\n"), "e.yaml:1: name: expected letters");
  expect_refusal("fly " + folder.file("f.yaml", "cameras:\n  rate_hz: 7\n"),
                 "f.yaml:2: cameras.rate_hz: expected");
  expect_refusal("fly " + folder.file("g.yaml", "name: a\nname: b\n"),
                 "g.yaml:2: name: expected each key once");
  expect_refusal("fly " + folder.file("h.yaml", "name: a\nrig: none\n"), "h.yaml:2: rig: expected a name");
  expect_refusal("fly " + folder.path.string(), "this is a folder");
  expect_refusal("fly clear --set rig=none --out " + folder.path.string(),
                 "--set rig=none: rig: expected a name");
  expect_refusal("fly clear --set rig=" + folder.file("rig.yaml", "name: a\n"),
                 "rig.yaml:1: width_px: expected");
  expect_refusal("fly clear --set 'forest={clear_m: 9, clear_m: 9}'",
                 "forest.clear_m: expected each key once");
  expect_refusal("fly clear --seed x", "seed: expected a whole number");
  expect_refusal("evaluate clear --seeds 9:1", "--seeds 9:1");
}

TEST(Cli, AnUnwritableFolderIsBadInputAndAFullDiskTheMachines) {
  const Folder folder;
  const std::string in_the_way = folder.file("file", "");
  expect_refusal("fly clear --out " + in_the_way + "/run", "expected a writable output");
  fs::create_directories(folder.path / "full");
  fs::create_symlink("/dev/full", folder.path / "full" / "scenario.yaml.part");
  expect_refusal("fly clear --out " + (folder.path / "full").string(), "No space left on device", 3);
  EXPECT_FALSE(fs::exists(folder.path / "full" / "result.json"));
}

TEST(Cli, AMissingLibraryOrModelIsTheMachines) {
  const Folder folder;
  const std::string out = " --out " + (folder.path / "run").string();
  expect_refusal("fly clear" + out, "libosmesa6", 3, "UNDERSTORY_OSMESA=/nonexistent");
  expect_refusal("fly clear" + out, "UNDERSTORY_ROOT=/nonexistent", 2, "UNDERSTORY_ROOT=/nonexistent");
  const fs::path models = folder.path / "root" / "models";
  fs::create_directories(folder.path / "root" / "scenarios");
  fs::create_directories(models / "airframe");
  fs::copy(fs::path(UNDERSTORY_SOURCE_DIR) / "models" / "rigs", models / "rigs");
  const std::string scenario = folder.file("a.yaml", "course: clear\n");
  const std::string elsewhere = "UNDERSTORY_ROOT=" + (folder.path / "root").string();
  expect_refusal("fly " + scenario + out, "delta_wing.xml", 3, elsewhere);
  std::ofstream(models / "airframe" / "delta_wing.xml") << "<mujoco";
  expect_refusal("fly " + scenario + out, "MuJoCo refuses", 3, elsewhere);
  EXPECT_FALSE(fs::exists(folder.path / "run" / "result.json"));
}

TEST(Cli, AnyWorkingDirectoryServes) {
  const Folder folder;
  fs::create_directories(folder.path / "clear");  // a folder of that name must not hide the library's
  const std::string go_there = "cd " + folder.path.string() + " && ";
  const std::string flight = " --set forest.length_m=1 --out short";
  EXPECT_EQ(understory("fly clear" + flight, go_there).status, 0);
  EXPECT_EQ(understory("fly scenarios/library/clear.yaml --quiet" + flight, go_there).text, "");
  EXPECT_TRUE(fs::exists(folder.path / "short" / "result.json"));
}

#else

TEST(Cli, WithoutASimulatorItSaysSo) { expect_refusal("fly clear", "expected a build with the simulator"); }

#endif

}  // namespace
