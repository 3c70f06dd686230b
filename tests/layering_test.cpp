#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/source_code.hpp"
#include "tests/support/temporary_folder.hpp"

/// Who may include whom, and how large anything may grow (docs/architecture.md). Read from the sources
/// themselves, so that a breach fails here by name and not months later as a tangle.
namespace understory {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;
using Graph = std::map<std::string, Names>;

const fs::path root = UNDERSTORY_SOURCE_DIR;
const std::vector<std::string> product_folders{"perception", "estimation", "planning", "sim", "scenarios"};

std::vector<SourceFile> read_folders(const std::vector<std::string>& folders) {
  std::vector<SourceFile> all;
  for (const std::string& folder : folders) {
    for (SourceFile& file : read_source_files(root, folder)) all.push_back(std::move(file));
  }
  return all;
}

const std::vector<SourceFile>& product() {
  static const std::vector<SourceFile> files = read_folders(product_folders);
  return files;
}

const std::vector<SourceFile>& tests() {
  static const std::vector<SourceFile> files = read_folders({"tests"});
  return files;
}

std::string top(const std::string& path) {
  const std::string first = path.substr(0, path.find('/'));
  const bool ours = std::find(product_folders.begin(), product_folders.end(), first) != product_folders.end();
  return ours ? first : "";
}

/// Of a path in scenarios its folder there: `flight` of scenarios/parts/oracles.hpp.
std::string room(const std::string& path) {
  const std::string rest = path.substr(path.find('/') + 1);
  return top(path) == "scenarios" ? rest.substr(0, rest.find('/')) : "";
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const std::string& beginning) { return text.starts_with(beginning); });
}

/// All that can be reached from each name along the graph.
Graph closure(const Graph& graph) {
  Graph reached;
  for (const auto& [start, direct] : graph) {
    Names& names = reached[start];
    std::vector<std::string> open(direct.begin(), direct.end());
    while (!open.empty()) {
      const std::string next = open.back();
      open.pop_back();
      if (!names.insert(next).second || !graph.contains(next)) continue;
      for (const std::string& further : graph.at(next)) open.push_back(further);
    }
  }
  return reached;
}

/// Every header, ours or not, that a file of the product reads, through others too.
const Graph& reached_headers() {
  static const Graph reached = [] {
    Graph direct;
    for (const SourceFile& file : product()) {
      direct[file.path] = Names(file.includes.begin(), file.includes.end());
    }
    return closure(direct);
  }();
  return reached;
}

/// Breaches that are known and wait to be mended, of one rule: lines `rule: breach` of
/// tests/known_breaches.txt.
Names known_breaches(const std::string& rule) {
  Names known;
  std::ifstream stream(root / "tests/known_breaches.txt");
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(rule + ": ")) known.insert(line.substr(rule.size() + 2));
  }
  return known;
}

void expect_only_known(const std::string& rule, const Names& found) {
  const Names known = known_breaches(rule);
  for (const std::string& breach : found) EXPECT_TRUE(known.contains(breach)) << rule << ": " << breach;
  for (const std::string& breach : known) {
    EXPECT_TRUE(found.contains(breach))
        << "mended, strike it out of tests/known_breaches.txt: " << rule << ": " << breach;
  }
}

/// Headers of plain types and interfaces: the _types targets.
const Names type_headers{"perception/stereo_frame.hpp",
                         "perception/stereo_rig.hpp",
                         "perception/stereo_calibration.hpp",
                         "perception/stereo_hit.hpp",
                         "perception/obstacle_point.hpp",
                         "perception/obstacle_detector.hpp",
                         "perception/perception_config.hpp",
                         "estimation/samples.hpp",
                         "estimation/state.hpp",
                         "estimation/state_source.hpp",
                         "estimation/filter_config.hpp",
                         "planning/airframe.hpp",
                         "planning/plan.hpp"};

const std::string field_visitor = "perception/field_visitor.hpp";

bool may_reach(const std::string& file, const std::string& header) {
  const std::string from = top(file), to = top(header);
  const bool is_type = type_headers.contains(header);
  if (header == field_visitor) return true;  // names no type of anybody's
  if (type_headers.contains(file)) return to.empty() || (is_type && to == from);
  if (to.empty() || to == from || from == "scenarios") return true;
  if (from == "planning") {
    return (to == "perception" || to == "estimation") && (is_type || file.starts_with("planning/autopilot"));
  }
  return from == "sim" && to != "scenarios" && is_type;  // perception and estimation know nobody
}

TEST(Layering, FoldersReachOnlyWhomTheyMay) {
  Names found;
  for (const auto& [file, headers] : reached_headers()) {
    for (const std::string& header : headers) {
      if (!may_reach(file, header)) found.insert(file + " reaches " + header);
    }
  }
  expect_only_known("reach", found);
}

/// Inside scenarios arrows point from a higher floor to a lower one, or along one; what serves all stands
/// apart.
bool arrow_points_down(const std::string& from, const std::string& to) {
  static const std::map<std::string, int> floors{
      {"config", 1},     {"course", 2},  {"parts", 3}, {"scenario", 4}, {"flight", 5},
      {"recording", 6},  {"detect", 6},  {"bench", 6}, {"tuning", 7},   {"campaign", 7},
      {"evaluation", 7}, {"explain", 8}, {"cli", 9},   {"python", 9}};
  if (from == "statistics" || from == "output") return false;  // they know nobody
  if (to == "statistics" || to == "output") return true;
  if (from == "report") return to == "config";
  if (to == "report") return from != "config";
  return floors.contains(from) && floors.contains(to) && floors.at(from) >= floors.at(to);
}

TEST(Layering, ArrowsInsideScenariosPointDown) {
  Names found;
  for (const SourceFile& file : product()) {
    const std::string from = room(file.path);
    for (const std::string& header : file.includes) {
      const std::string to = room(header);
      if (from.empty() || to.empty() || from == to) continue;
      if (!arrow_points_down(from, to)) found.insert(from + " > " + to);
    }
  }
  expect_only_known("arrow", found);
}

TEST(Layering, NoFolderReachesItself) {
  Graph folders;
  for (const SourceFile& file : product()) {
    for (const std::string& header : file.includes) {
      const std::string to = header.substr(0, header.rfind('/'));
      if (!top(header).empty() && to != file.folder()) folders[file.folder()].insert(to);
    }
  }
  const Graph reached = closure(folders);
  Names found;
  for (const auto& [folder, others] : reached) {
    if (!others.contains(folder)) continue;
    std::string circle;
    for (const std::string& other : others) {
      if (reached.contains(other) && reached.at(other).contains(folder)) circle += other + " ";
    }
    found.insert(circle.substr(0, circle.size() - 1));
  }
  expect_only_known("cycle", found);
}

const std::vector<std::string> simulator{"mujoco", "GL/", "EGL/", "epoxy/"};

TEST(Layering, OutsideLibrariesStayWhereTheyBelong) {
  const std::vector<std::string> text{"yaml-cpp", "nlohmann", "CLI/", "spdlog",
                                      "boost/",   "pugixml",  "ompl", "pagmo"};
  Names found;
  for (const SourceFile& file : product()) {
    for (const std::string& header : file.includes) {
      const bool strange =
          (starts_with_any(header, simulator) && top(file.path) != "sim") ||
          (starts_with_any(header, text) && !file.is_source() &&
           header != "nlohmann/json_fwd.hpp") ||  // declares names only
          (header.starts_with("ompl") && top(file.path) != "planning") ||
          (header.starts_with("opencv2") && top(file.path) == "estimation") ||
          // Two hundred libraries: docs/decisions/014.
          (header == "opencv2/imgcodecs.hpp" && file.path != "perception/io/picture_codecs.cpp") ||
          (header == "png.h" && file.path != "perception/io/png_codec.cpp");
      if (strange) found.insert(file.path + " includes " + header);
    }
  }
  expect_only_known("library", found);
}

/// A build without the simulator defines the same commands, and only these: their files are those of the
/// program's own list of sources, or they refuse in no_simulator.cpp.
TEST(Layering, ABuildWithoutTheSimulatorHasEveryCommand) {
  const std::string lists = support::content_of(root / "scenarios/CMakeLists.txt");
  const std::size_t begin = lists.find("add_executable(understory "), end = lists.find(')', begin);
  std::string there = support::content_of(root / "scenarios/cli/no_simulator.cpp");
  for (const SourceFile& file : product())
    if (file.path.starts_with("scenarios/cli/") &&
        lists.substr(begin, end - begin).find(file.path.substr(10)) != std::string::npos &&
        file.path != "scenarios/cli/main.cpp")
      there += support::content_of(root / file.path);
  const std::string main = support::content_of(root / "scenarios/cli/main.cpp");
  const std::regex added(R"(\n  (add_[a-z]+_command)\(line\);)");
  int commands = 0;
  for (std::sregex_iterator one(main.begin(), main.end(), added), none; one != none; ++one, ++commands)
    EXPECT_NE(there.find("void " + one->str(1) + "(CommandLine& line) {"), std::string::npos) << one->str(1);
  EXPECT_GT(commands, 15);
}

TEST(Layering, WhatIsIncludedFromOutsideShowsNoSimulator) {
  Names found;
  for (const SourceFile& file : product()) {
    if (top(file.path) == "sim") continue;
    for (const std::string& header : file.includes) {
      if (top(header) != "sim") continue;
      for (const std::string& reached : reached_headers().at(header)) {
        if (starts_with_any(reached, simulator)) found.insert(header + " shows " + reached);
      }
    }
  }
  expect_only_known("simulator", found);
}

TEST(Layering, TruthStaysOutOfTheStack) {
  for (const auto& [file, headers] : reached_headers()) {
    if (top(file) == "sim" || top(file) == "scenarios") continue;
    for (const std::string& header : headers) {
      EXPECT_EQ(header.find("truth"), std::string::npos) << file << " may not know " << header;
    }
  }
}

TEST(Layering, IncludePathsStartAtTheRoot) {
  ASSERT_GT(product().size(), 100u);
  for (const SourceFile& file : product()) {
    for (const std::string& header : file.includes) {
      EXPECT_EQ(header.find(".."), std::string::npos) << file.path << " includes " << header;
      EXPECT_TRUE(top(header).empty() || fs::exists(root / header) || header.ends_with(".pb.h"))
          << file.path << " includes " << header;
    }
  }
}

/// One type of a name: two that differ break the program without a word from compiler or linker.
TEST(Layering, ATypeIsDefinedOnce) {
  std::map<std::string, Names> files_of;
  for (const std::vector<SourceFile>* files : {&product(), &tests()}) {
    for (const SourceFile& file : *files) {
      for (const std::string& type : file.types) files_of[type].insert(file.path);
    }
  }
  Names found;
  for (const auto& [type, files] : files_of) {
    if (files.size() > 1) found.insert(type);
  }
  expect_only_known("type", found);
}

TEST(Size, AFunctionFitsAScreen) {
  Names found;
  for (const std::vector<SourceFile>* files : {&product(), &tests()}) {
    for (const SourceFile& file : *files) {
      for (const SourceFunction& function : file.functions) {
        if (function.lines > 70) found.insert(file.path + " " + function.name);
      }
    }
  }
  expect_only_known("function", found);
}

/// A subject is a header with its source.
TEST(Size, AFoldersRootHoldsAtMostTwentySubjects) {
  std::map<std::string, Names> subjects;
  for (const SourceFile& file : product())
    subjects[file.folder()].insert(file.path.substr(0, file.path.rfind('.')));
  subjects.erase("scenarios/cli");  // a file a command
  Names found;
  for (const auto& [folder, names] : subjects) {
    if (names.size() > 20) found.insert(folder);
  }
  expect_only_known("subjects", found);
}

int lines_of(const std::vector<SourceFile>& files, const std::function<bool(const SourceFile&)>& counts) {
  int lines = 0;
  for (const SourceFile& file : files) lines += counts(file) ? file.lines : 0;
  return lines;
}

/// Lines of the page's program, and its longest function: those that begin in the first column, and methods.
struct PageProgram {
  int lines = 0, longest_file = 0, longest_function = 0;
};

PageProgram page_program() {
  PageProgram program;
  for (const auto& entry : fs::directory_iterator(root / "scenarios/report/page/src")) {
    std::ifstream stream(entry.path());
    int lines = 0, begin = 0;
    std::string end;
    const std::regex head(R"(^(  )?(export |private |public |static |async |function )*[a-z_]+\(.*\{$)");
    for (std::string line; std::getline(stream, line);) {
      ++lines;
      if (end.empty() && std::regex_search(line, head) && !line.starts_with("  if") &&
          !line.starts_with("  for")) {
        begin = lines;
        end = line.starts_with("  ") ? "  }" : "}";
      } else if (!end.empty() && line == end) {
        program.longest_function = std::max(program.longest_function, lines - begin + 1);
        end.clear();
      }
    }
    program.lines += lines;
    program.longest_file = std::max(program.longest_file, lines);
  }
  return program;
}

int python_lines() {
  int lines = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root / "scenarios/python")) {
    const fs::path ending = entry.path().extension();
    std::ifstream stream(entry.path());
    std::string line;
    while ((ending == ".py" || ending == ".pyi") && std::getline(stream, line)) ++lines;
  }
  return lines;
}

/// The size that the decision page of that number allows: "`product_lines 44000`".
int allowed_by(const std::string& page, const std::string& size) {
  for (const auto& entry : fs::directory_iterator(root / "docs/decisions")) {
    if (!entry.path().filename().string().starts_with(page + "-")) continue;
    const std::string text = support::content_of(entry.path());
    const std::size_t found = text.find('`' + size + ' ');
    if (found != std::string::npos) return std::atoi(text.c_str() + found + size.size() + 2);
  }
  return 0;
}

/// tests/sizes.txt holds the sizes of the tree, each with the decision page that allows it.
TEST(Size, OnlyGoesDown) {
  const auto is_validation = [](const SourceFile& file) {
    return file.path.starts_with("tests/validation/");
  };
  const PageProgram page = page_program();
  int longest_file = page.longest_file, longest_function = 0;
  for (const SourceFile& file : product()) {
    longest_file = std::max(longest_file, file.lines);
    for (const SourceFunction& function : file.functions)
      longest_function = std::max(longest_function, function.lines);
  }
  const std::map<std::string, int> measured{
      {"product_lines",
       page.lines + python_lines() + lines_of(product(), [](const SourceFile&) { return true; })},
      {"test_lines", lines_of(tests(), [&](const SourceFile& file) { return !is_validation(file); })},
      {"validation_lines", lines_of(tests(), is_validation)},
      {"longest_product_file", longest_file},
      {"longest_function", longest_function},
      {"longest_typescript_function", page.longest_function}};
  std::ifstream stream(root / "tests/sizes.txt");
  std::map<std::string, int> held;
  std::string name, page_number;
  for (int number = 0; stream >> name >> number >> page_number; held[name] = number)
    EXPECT_LE(number, allowed_by(page_number, name)) << "tests/sizes.txt: decision page " << page_number
                                                     << " must allow `" << name << ' ' << number << '`';
  for (const auto& [what, number] : measured)
    EXPECT_EQ(held[what], number) << "tests/sizes.txt: write " << number << " at " << what
                                  << "; more than before needs a page in docs/decisions that allows it";
  EXPECT_EQ(held.size(), measured.size());
}

/// The reader of sources itself.
TEST(Layering, SourcesAreReadAsTheyStand) {
  const fs::path file = fs::temp_directory_path() / "understory_layering.cpp";
  std::ofstream(file) << R"code(#include <a/b.hpp>
// struct Comment {
namespace outer::inner {
template <typename T = int>
struct Plain final : Base<T> {
  enum class Kind { one, two };
  Plain(int x) : x_{x}, text_("}{") {
    struct Local {};
  }
};
namespace { struct Hidden {}; }
const std::vector<char> list{'{', 1'000};
auto made(std::function<void()> f = [] {}) -> int
{
  return R"(
})"[0];
}
struct Forward;
}
)code";
  const SourceFile read = read_source_file(file.parent_path(), file);
  fs::remove(file);
  EXPECT_EQ(read.includes, std::vector<std::string>{"a/b.hpp"});
  EXPECT_EQ(read.types, (std::vector<std::string>{"outer::inner::Plain", "outer::inner::Plain::Kind"}));
  ASSERT_EQ(read.functions.size(), 2u);
  EXPECT_EQ(read.functions[0].name, "Plain");
  EXPECT_EQ(read.functions[0].lines, 3);
  EXPECT_EQ(read.functions[1].name, "made");
  EXPECT_EQ(read.functions[1].lines, 5);
  EXPECT_EQ(read.lines, 19);
}

}  // namespace
}  // namespace understory
