#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

/// Who may include whom (docs/architecture.md). Read from the #include lines of the whole tree, so that a
/// breach fails here by name and not months later as a tangle.
namespace {

namespace fs = std::filesystem;
const fs::path root = UNDERSTORY_SOURCE_DIR;
const std::vector<std::string> folders{"perception", "estimation", "planning", "sim", "scenarios"};

struct Include {
  std::string file;    ///< relative to the root
  std::string folder;  ///< its top folder
  std::string header;  ///< as written
};

std::vector<Include> includes_under(const std::string& top) {
  std::vector<Include> includes;
  const std::regex pattern(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  if (!fs::exists(root / top)) return includes;
  for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
    const std::string extension = entry.path().extension().string();
    if (!entry.is_regular_file() || (extension != ".hpp" && extension != ".cpp" && extension != ".h"))
      continue;
    std::ifstream stream(entry.path());
    std::smatch match;
    for (std::string line; std::getline(stream, line);) {
      if (std::regex_search(line, match, pattern)) {
        includes.push_back({fs::relative(entry.path(), root).string(), top, match[1]});
      }
    }
  }
  return includes;
}

std::string folder_of(const std::string& header) {
  const std::string top = header.substr(0, header.find('/'));
  for (const std::string& folder : folders) {
    if (folder == top) return folder;
  }
  return "";
}

/// Headers of plain types and interfaces: the _types targets.
const std::set<std::string> types{
    "perception/stereo_frame.hpp", "perception/stereo_rig.hpp",     "perception/stereo_calibration.hpp",
    "perception/stereo_hit.hpp",   "perception/obstacle_point.hpp", "perception/obstacle_detector.hpp",
    "estimation/samples.hpp",      "estimation/state.hpp",          "estimation/state_source.hpp",
    "planning/airframe.hpp",       "planning/controls.hpp",         "planning/plan.hpp"};

bool may_include(const Include& include) {
  const std::string& from = include.folder;
  const std::string to = folder_of(include.header);
  if (to.empty() || to == from || from == "scenarios") return true;
  const bool is_type = types.contains(include.header);
  if (from == "planning") {
    const bool is_autopilot = include.file.find("planning/autopilot") == 0;
    return (to == "perception" || to == "estimation") && (is_type || is_autopilot);
  }
  if (from == "sim") return to != "scenarios" && is_type;
  return false;  // perception and estimation know nobody
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  for (const std::string& beginning : beginnings) {
    if (text.rfind(beginning, 0) == 0) return true;
  }
  return false;
}

std::vector<Include> all_includes() {
  std::vector<Include> all;
  for (const std::string& folder : folders) {
    const std::vector<Include> some = includes_under(folder);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

TEST(Layering, FoldersIncludeOnlyWhomTheyMay) {
  const std::vector<Include> all = all_includes();
  ASSERT_GT(all.size(), 100u);
  for (const Include& include : all) {
    EXPECT_TRUE(may_include(include)) << include.file << " may not include " << include.header;
  }
}

TEST(Layering, OutsideLibrariesStayWhereTheyBelong) {
  const std::vector<std::string> simulator{"mujoco", "GL/", "EGL/"};
  const std::vector<std::string> text{"yaml-cpp", "nlohmann", "CLI", "spdlog", "boost/", "pugixml"};
  for (const Include& include : all_includes()) {
    const bool is_source = include.file.ends_with(".cpp");
    if (starts_with_any(include.header, simulator)) {
      EXPECT_EQ(include.folder, "sim") << include.file << " may not include " << include.header;
    }
    if (starts_with_any(include.header, {"ompl"})) {
      EXPECT_TRUE(include.folder == "planning" && is_source)
          << include.file << " may not include " << include.header;
    }
    if (starts_with_any(include.header, text)) {
      EXPECT_TRUE(is_source) << include.file << " may not include " << include.header
                             << ": only .cpp files may";
    }
    if (include.header == "opencv2/imgcodecs.hpp") {  // two hundred libraries: docs/decisions/014
      EXPECT_EQ(include.file, "perception/io/picture_codecs.cpp") << include.file;
    }
    if (starts_with_any(include.header, {"opencv2"})) {
      EXPECT_NE(include.folder, "estimation") << include.file;
    }
  }
}

TEST(Layering, TruthStaysOutOfTheStack) {
  for (const Include& include : all_includes()) {
    if (include.folder == "sim" || include.folder == "scenarios") continue;
    EXPECT_EQ(include.header.find("truth"), std::string::npos) << include.file << " may not know the truth";
  }
}

TEST(Layering, NobodyIncludesScenariosAndPathsStartAtTheRoot) {
  for (const Include& include : all_includes()) {
    EXPECT_EQ(include.header.find(".."), std::string::npos) << include.file << " includes " << include.header;
    if (folder_of(include.header).empty()) continue;
    EXPECT_TRUE(fs::exists(root / include.header)) << include.file << " includes " << include.header;
  }
}

}  // namespace
