#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// The program as people and CI meet it: exit statuses and one-line messages.
namespace understory::support {
namespace {

namespace fs = std::filesystem;
using Cli = FolderTest;

void expect_parts(const ProgramRun& outcome, const std::vector<std::string>& parts) {
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  for (const std::string& part : parts) expect_part(outcome.text, part);
}

TEST_F(Cli, HelpShowsExitStatusesAndAnExampleForEveryCommand) {
  const ProgramRun help = understory("--help");
  for (const char* command : {"fly", "record", "detect", "evaluate", "campaign", "shard", "collect", "gate",
                              "tune", "rig", "bench"}) {
    expect_parts(help, {std::string("\n  ") + command + " "});
    expect_parts(understory(std::string(command) + " --help"),
                 {"Example:\n  understory ", "Exit status:\n", "bad input", "130, 143"});
  }
}

TEST_F(Cli, VersionSaysCommitAndRenderer) {
  const ProgramRun version = understory("--version");
  expect_parts(version, {"understory ", "(", ")\nrenderer: "});
  const bool is_checkout =
      std::system("git -C '" UNDERSTORY_SOURCE_DIR "' rev-parse HEAD >/dev/null 2>&1") == 0;
  EXPECT_EQ(version.text.find("unknown") == std::string::npos, is_checkout) << version.text;
}

TEST_F(Cli, TheManualNamesCommandsAndOptions) {
  const ProgramRun manual = understory("manual");
  expect_parts(manual, {".TH UNDERSTORY 1", ".SS gate", "\\-\\-margin", ".SH EXIT STATUS"});
  expect_no_part(manual.text, "completion");  // hidden
}

/// What bash offers for a line whose last word is being typed.
std::string completed(const std::vector<std::string>& words) {
  std::string line = "bash -c 'set -e; source <(" UNDERSTORY_BINARY
                     " completion bash); compopt() { :; }; "
                     "PATH=" +
                     fs::path(UNDERSTORY_BINARY).parent_path().string() + ":$PATH; COMP_WORDS=(understory";
  for (const std::string& word : words) line += " \"" + word + "\"";
  line += "); COMP_CWORD=" + std::to_string(words.size()) + "; _understory understory \"" + words.back() +
          "\" \"" + (words.size() > 1 ? words[words.size() - 2] : "understory") +
          "\"; echo \"${COMPREPLY[*]}\"'; true";
  return understory("--version >/dev/null; " + line).text;
}

TEST_F(Cli, BashCompletesCommandsOptionsAndValues) {
  EXPECT_EQ(completed({"ca"}), "campaign\n");
  EXPECT_EQ(completed({"fly", "--vid"}), "--video\n");
  EXPECT_EQ(completed({"fly", "--renderer", "o"}), "osmesa\n");
  EXPECT_EQ(completed({"rig", "lon"}), "long\n");
  EXPECT_NE(completed({"fly", "goal"}).find("goalposts"), std::string::npos);
}

TEST_F(Cli, AnEmptyValueIsAnErrorAndNoDefault) {
  for (const char* arguments :
       {"rig long --out ''", "rig ''", "rig long --out=", "rig long --depth ''",
        "rig long --size=", "detect a b --set ''", "detect a '' --rig long", "collect ''", "bench --pairs ''",
        "bench --json=", "gate --baseline '' --candidate b", "evaluate ''"})
    expect_refusal(arguments, "needs a value");
#ifdef UNDERSTORY_HAS_SIM
  // A CI whose variable is not set must not fly seed 1000 and pass.
  for (const char* arguments :
       {"fly forest --seed ''", "fly forest --seed=", "fly --seed= forest clear", "fly forest --out ''",
        "fly ''", "fly forest --with ''", "fly forest --set ''", "fly forest --row ''",
        "fly forest --junit=", "fly forest --renderer ''", "record forest --out ''",
        "record forest --out x --walk=", "campaign ''", "campaign x --jobs ''", "tune ''", "shard ''"})
    expect_refusal(arguments, "needs a value");
#endif
}

/// Under a sanitizer the program opens nothing late (scenarios/CMakeLists.txt).
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool opens_codecs_late = false;
#else
constexpr bool opens_codecs_late = true;
#endif

TEST_F(Cli, LibrariesOfPicturesAndFilmsAreNotLoadedAtTheStart) {
  if (!opens_codecs_late) GTEST_SKIP() << "linked, under a sanitizer";
  const ProgramRun libraries = understory("", "LD_TRACE_LOADED_OBJECTS=1");  // what ldd asks the loader for
  expect_part(libraries.text, "libopencv_core");
  for (const char* late : {"libopencv_imgcodecs", "libopencv_videoio", "libavcodec", "libgdal"})
    expect_no_part(libraries.text, late);
}

TEST_F(Cli, APictureWithoutItsModuleIsTheMachinesFault) {
  if (!opens_codecs_late) GTEST_SKIP() << "linked, under a sanitizer";
  const fs::path alone = folder.path() / "understory";
  fs::copy_file(UNDERSTORY_BINARY, alone);
  const std::string image = " " UNDERSTORY_SOURCE_DIR "/docs/images/report.jpg";
  const std::string elsewhere = "UNDERSTORY_ROOT=" UNDERSTORY_SOURCE_DIR " " + alone.string();
  // `before` runs the lonely copy; the program itself then only says its version.
  const ProgramRun refused =
      understory("--version", elsewhere + " detect" + image + image + " --rig long 2>&1; echo status $?;");
  expect_part(refused.text, "pictures and films need a module");
  expect_part(refused.text, "status 3");
  const ProgramRun without = understory("--version", elsewhere + " rig long 2>&1; echo status $?;");
  expect_part(without.text, "status 0");
  expect_refusal("detect" + image + image + " --rig long", "found 8-bit colour");  // it was read
}

TEST_F(Cli, ThePrefixItIsInstalledInMayBeAnywhere) {
  const fs::path share = folder.path() / "prefix" / "share" / "understory";
  fs::create_directories(folder.path() / "prefix" / "bin");
  fs::create_directories(share);
  const fs::path program = folder.path() / "prefix" / "bin" / "understory";
  fs::copy_file(UNDERSTORY_BINARY, program);
  const std::string rig =
      "cd / && env -u UNDERSTORY_ROOT " + program.string() + " rig long 2>&1; echo status $?;";
  const ProgramRun without = understory("--version", rig);
  expect_part(without.text, "models/ and scenarios/ are missing");
  expect_part(without.text, "status 3");
  for (const char* part : {"models", "scenarios"})
    fs::create_directory_symlink(fs::path(UNDERSTORY_SOURCE_DIR) / part, share / part);
  EXPECT_NE(understory("--version", rig).text.find("status 0"), std::string::npos);
}

TEST_F(Cli, WrongArgumentsAreBadInput) {
  expect_refusal("", "the commands are fly, record");
  expect_refusal("soar", "soar: unknown command");
  expect_refusal("flly clear", "did you mean fly?");
#ifdef UNDERSTORY_HAS_SIM
  expect_refusal("fly forst", "woods_low (did you mean forest?)");
#endif
  expect_refusal("rig long --dept 3", "rig --dept: unknown option (did you mean --depth?)");
  expect_refusal("rig long --dept=3", "did you mean --depth?");
  expect_refusal("rig long paper", "rig paper: one argument too many");
  expect_refusal("bench --rounds 0", "--rounds 0: must be a whole number from 1 to 100000");
  expect_refusal("bench --rounds 3 --rounds 4", "--rounds");
}

const std::string raw_rigs = UNDERSTORY_SOURCE_DIR "/models/rigs/raw/";

TEST_F(Cli, RigSaysWhatACalibrationMeans) {
  const ProgramRun paper = understory("rig " + raw_rigs + "paper.xml --unit cm --size 376x240 --depth 4.8");
  EXPECT_EQ(paper.status, 0);
  for (const char* part :
       {"376 x 240 px", "8 distortion coefficients left, 8 right", "180.40 px", "0.3530 m",
        "left 197.46, right 105.70", "91.76 px", "4.81 m: 105 px", "4.47 to 5.20 m", "u - 95 to u - 89"})
    expect_part(paper.text, part);
  EXPECT_LT(std::count(paper.text.begin(), paper.text.end(), '\n'), 24);  // one screen
  EXPECT_NE(understory("rig " + raw_rigs + "long.xml --depth 10").text.find("10.14 m: 33 px"),
            std::string::npos);
  EXPECT_NE(understory("rig paper").text.find("come rectified"), std::string::npos);
}

TEST_F(Cli, RigDrawsWhatItSays) {
  const std::string picture = path("rig.svg");
  const ProgramRun drawn = understory("rig long --out " + picture);
  EXPECT_EQ(drawn.status, 0);
  expect_part(drawn.text, picture);
  understory::support::expect_part(understory::support::content_of(picture), "detects at 10.14 m (33 px)");
}

TEST_F(Cli, BadRigsAreNamedInOneLine) {
  expect_refusal("rig", "FILE");
  expect_refusal("rig nowhere", "rigs of the library: fisheye, long, paper");
  expect_refusal("rig " + raw_rigs + "paper.xml", "paper.xml: baseline in m: must be from 0.01 to 10");
  expect_refusal("rig " + raw_rigs + "long.xml --unit ft",
                 "--unit ft: must be m, cm, mm or a number of metres");
  for (const char* size : {"376", "376x", "x240", "376x240x8", "wide"})
    expect_refusal("rig " + raw_rigs + "long.xml --size " + size, "must be WIDTHxHEIGHT");
  expect_refusal("rig " + raw_rigs + "long.xml --size 640x480", "image size: the file says 376x240");
  expect_refusal("rig " + raw_rigs + "long.xml --depth deep", "--depth");
  expect_refusal("rig " + raw_rigs + "long.xml --depth nan",
                 "--depth nan: must be a number from 0.1 to 1000");
  expect_refusal("rig " + raw_rigs + "long.xml --depth 800", "nearer than infinity");
  expect_refusal("rig " + folder.path().string(), "holds no calibration: expected cam0 and cam1");
  expect_refusal("rig " + file("rig.yaml", "name: [\n"), "rig.yaml:");
  expect_refusal("rig " + file("rig.xml", "<opencv_storage><M1>"), "rig.xml:1: not valid XML of OpenCV");
}

TEST_F(Cli, APictureThatCannotBeWrittenIsBadInput) {
  expect_refusal("rig long --out " + (folder.path() / "none" / "rig.svg").string(), "cannot write here");
  expect_refusal("rig long --out " + path("rig.xyz"), "the name must end in .yaml, or in .svg for a drawing");
}

#ifdef UNDERSTORY_HAS_SIM

TEST_F(Cli, BadScenariosAreNamedByFileLineAndKey) {
  expect_refusal("fly", "scenario");
  expect_refusal("fly nowhere", "clear, dense, fence, forest, goalposts, horizon, inventory");
  expect_refusal("fly " + file("a.yaml", "name: a\nforest:\n  lenght_m: 3\n"), "a.yaml:3: forest.lenght_m");
  expect_refusal("fly " + file("b.yaml", "name: [\n"), "b.yaml:");
  expect_refusal("fly clear --set forest.length_m=-1", "--set forest.length_m=-1: forest.length_m: expected");
  expect_refusal("fly " + file("c.yaml", ""), "c.yaml:1: must be one YAML document");
  expect_refusal("fly " + file("d.yaml", "forest: &again [*again]\n"),
                 "d.yaml:1: an alias must not refer to the value that contains it");
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string alias = "*a" + std::to_string(i - 1), name = "a" + std::to_string(i);
    bomb += name + ": &" + name + " [" + alias;
    for (int copy = 1; copy < 10; ++copy) bomb += ", " + alias;
    bomb += "]\n";
  }
  expect_refusal("fly " + file("bomb.yaml", bomb), "a file may hold at most 100,000 values");
  expect_refusal("fly /dev/zero", "/dev/zero: cannot read this file, this is a device");
  expect_refusal("fly " + file("e.yaml", "name: a/b\n"), "e.yaml:1: name: must be letters");
  expect_refusal("fly " + file("f.yaml", "cameras:\n  rate_hz: 7\n"),
                 "f.yaml:2: cameras.rate_hz: must divide");
  expect_refusal("fly " + file("g.yaml", "name: a\nname: b\n"), "g.yaml:2: name: this key is given twice");
  expect_refusal("fly " + file("h.yaml", "name: a\nrig: none\n"), "h.yaml:2: rig: must be a name");
  expect_refusal("fly " + folder.path().string(), "is a folder");
  expect_refusal("fly clear --set rig=none --out " + folder.path().string(),
                 "--set rig=none: rig: must be a name");
  expect_refusal("fly clear --set rig=" + file("rig.yaml", "name: a\n"), "rig.yaml:1: width_px: ");
  expect_refusal("fly clear --set 'forest={clear_m: 9, clear_m: 9}'",
                 "forest.clear_m: this key is given twice");
  expect_refusal("fly clear --seed x", "seed: expected a whole number");
  expect_refusal("fly clear --set 'perception.depths_m=[10, 900]' --out " + path("out"),
                 "perception.depths_m: the rig long cannot look at 900 m");
}

TEST_F(Cli, AnUnwritableFolderIsBadInput) {
  const std::string in_the_way = file("file", "");
  expect_refusal("fly clear --out " + in_the_way + "/run", "cannot write here");
}

TEST_F(Cli, ARendererIsOneOfThree) {
  expect_refusal("fly clear --renderer crayon", "osmesa, egl, auto");
  expect_refusal("fly clear --renderer egl --out " + folder.path().string(), "libegl1", 3,
                 "UNDERSTORY_EGL=/proc/nowhere/libEGL.so");
}

TEST_F(Cli, BenchTimesWholeFlights) {
  const std::string json = path("rows.json");
  const ProgramRun bench =
      understory("bench --closed-loop --flights 1 --set time_limit_s=0.5 --json " + json);
  EXPECT_EQ(bench.status, 0) << bench.text;
  for (const char* part : {"forest, one at a time", "dense, two side by side", "paper", "woods_dense",
                           "ms a pair", "ten times the trees"})
    expect_part(bench.text, part);
  EXPECT_GT(fs::file_size(json), 1000u);
  expect_refusal("bench --closed-loop somewhere", "INPUT");
  const ProgramRun refused = understory("bench --closed-loop --flights 1 --set no.such=1");
  EXPECT_EQ(refused.status, 2);
  expect_part(refused.text, "a flight refused its input");
}

TEST_F(Cli, BenchTimesThePlanner) {
  const std::string json = path("planner.json");
  const ProgramRun bench = understory("bench --planner --pairs 2 --rounds 1 --json " + json);
  EXPECT_EQ(bench.status, 0) << bench.text;
  for (const char* part :
       {"168 replans in dense", "168 replans in woods_dense", "168 replans in paper_depths"})
    expect_part(bench.text, part);
  expect_refusal("bench --planner --closed-loop", "--closed-loop");
  expect_refusal("bench --planner --rig long", "--rig");
  expect_refusal("bench --planner --set autopilot.method=no", "autopilot.method");
}

TEST_F(Cli, AMissingLibraryOrModelIsTheMachines) {
  const std::string out = " --out " + path("run");
  expect_refusal("fly clear" + out, "libosmesa6", 3, "UNDERSTORY_OSMESA=/proc/nowhere");
  expect_refusal("fly clear" + out, "UNDERSTORY_ROOT=/proc/nowhere", 2, "UNDERSTORY_ROOT=/proc/nowhere");
  const fs::path models = folder.path() / "root" / "models";
  fs::create_directories(folder.path() / "root" / "scenarios");
  fs::create_directories(models / "airframe");
  fs::copy(fs::path(UNDERSTORY_SOURCE_DIR) / "models" / "rigs", models / "rigs");
  const std::string scenario = file("a.yaml", "course: clear\n");
  const std::string elsewhere = "UNDERSTORY_ROOT=" + path("root");
  expect_refusal("fly " + scenario + out, "delta_wing.xml", 3, elsewhere);
  std::ofstream(models / "airframe" / "delta_wing.xml") << "<mujoco";
  expect_refusal("fly " + scenario + out, "MuJoCo refuses", 3, elsewhere);
  EXPECT_FALSE(fs::exists(folder.path() / "run" / "result.json"));
}

TEST_F(Cli, AnyWorkingDirectoryServes) {
  fs::create_directories(folder.path() / "clear");  // a folder of that name must not hide the library's
  const std::string go_there = "cd " + folder.path().string() + " && ";
  const std::string flight = " --set forest.length_m=1 --out short";
  EXPECT_EQ(understory("fly clear" + flight, go_there).status, 0);
  EXPECT_EQ(understory("fly scenarios/library/clear.yaml --quiet" + flight, go_there).text, "");
  EXPECT_TRUE(fs::exists(folder.path() / "short" / "result.json"));
}

#else

TEST_F(Cli, WithoutASimulatorItSaysSo) { expect_refusal("fly clear", "requires a build with the simulator"); }

#endif

}  // namespace
}  // namespace understory::support
