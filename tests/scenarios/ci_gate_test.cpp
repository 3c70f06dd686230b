#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// .ci/gate in a repository made for the test, whose "build" is a script around the program: each commit
/// flies with the settings in its file `settings`.
namespace understory::support {
namespace {

struct CiGate : FolderTest {
  std::string shell(const std::string& command) {
    const std::string script = "cd " + path("repository") + " && { " + command + "; } 2>&1";
    FILE* pipe = popen(("bash -c '" + script + "'; echo status $?").c_str(), "r");
    std::string text;
    std::array<char, 4096> buffer;
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) text += buffer.data();
    pclose(pipe);
    return text;
  }

  void SetUp() override {
    folder.write("repository/run",
                 "#!/bin/sh\n"
                 "cd \"$(dirname \"$0\")\" && ! grep broken settings || exit 1\n"
                 "mkdir -p build/release && cat >build/release/understory <<END\n"
                 "#!/bin/sh\n"
                 "if [ \"\\$1\" = campaign ] && [ ! -d \"\\$2\" ]; then more=\"$(cat settings)\"; fi\n"
                 "exec " UNDERSTORY_BINARY
                 " \"\\$@\" \\$more\n"
                 "END\n"
                 "chmod +x build/release/understory\n");
    folder.write("repository/short.yaml", "scenario: s.yaml\nseeds: 1001..1014\n");
    folder.write("repository/s.yaml",
                 "course: clear\ntime_limit_s: 2\nforest: {length_m: 1}\nperception: {detector: none}\n");
    folder.write("repository/settings", "");
    folder.write("repository/.gitignore", "/build/\n");
    expect_part(
        shell("mkdir .ci && cp " UNDERSTORY_SOURCE_DIR "/.ci/gate .ci/ && chmod +x run && git init -q && "
              "git config user.email a@b && git config user.name a && git add -A && git commit -qm before && "
              "git tag before"),
        "status 0\n");
  }

  /// The change: its settings.
  std::string judged(const std::string& settings, const std::string& options = "--margin 0.3") {
    folder.write("repository/settings", settings + "\n");
    return shell("git commit -qam change && .ci/gate before --campaign short.yaml " + options);
  }
  nlohmann::json json() {
    return nlohmann::json::parse(content_of(folder.path() / "repository/build/gate/gate.json"));
  }
};

TEST_F(CiGate, JudgesAGoodABadAnUndecidedAndABrokenChange) {
  std::string said = judged("--set sensors.seed=5");
  expect_part(said, "building the program before the change");
  expect_part(said, "not worse: ");
  expect_part(said, "status 0\n");
  EXPECT_EQ(json()["verdict"], "not worse");
  for (const char* file : {"gate.md", "gate.xml", "gate.html", "candidate/summary.md"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "repository/build/gate" / file)) << file;

  said = judged("--set sensors.seed=5 --set time_limit_s=0.1");
  expect_no_part(said, "before the change");  // it is kept
  expect_part(said, "worse: s: success fell by 100.0 percentage points, from 14 to 0 of 14");
  expect_part(said, "status 1\n");
  expect_part(content_of(folder.path() / "repository/build/gate/gate.md"), "understory fly ");

  said = judged("--set sensors.seed=7", "--margin 0.01 --limit 20");
  expect_part(said, "not enough flights: ");
  expect_part(said, "status 4\n");
  EXPECT_EQ(json()["all"]["pairs"], 20);  // six more than in the file

  said = judged("broken");
  expect_part(said, "the program after the change does not build");
  expect_part(said, "status 3\n");
  expect_part(content_of(folder.path() / "repository/build/gate/gate.md"), "broken");
}

TEST_F(CiGate, RefusesWhatItCannotJudge) {
  expect_part(shell(".ci/gate"), "status 2\n");
  expect_part(shell(".ci/gate nowhere"), "nowhere: no commit of this repository");
  expect_part(shell(".ci/gate HEAD --out"), "--out needs a value");
}

}  // namespace
}  // namespace understory::support
