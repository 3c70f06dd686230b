#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "tests/validation/aircraft_page.hpp"
#include "tests/validation/estimator_page.hpp"
#include "tests/validation/mismatch_page.hpp"
#include "tests/validation/page.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct ValidatedPart {
  const char* name;                              ///< as --only has it
  ValidationPage (*page)(const fs::path& root);  ///< measures and draws; `root`: the source tree
};

constexpr std::array parts{ValidatedPart{"aircraft", aircraft_page},
                           ValidatedPart{"estimator", estimator_page},
                           ValidatedPart{"mismatch", mismatch_page}};

struct ValidateArguments {
  std::string out = UNDERSTORY_SOURCE_DIR "/docs";
  std::vector<std::string> only;  // empty: all
};

void require_known(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (std::any_of(parts.begin(), parts.end(), [&](const ValidatedPart& part) { return part.name == name; }))
      continue;
    std::vector<std::string> known;
    for (const ValidatedPart& part : parts) known.emplace_back(part.name);
    throw ScenarioError(fmt::format("--only {}: expected one of: {}", name, fmt::join(known, ", ")));
  }
}

int run_validate(const ValidateArguments& arguments) {
  require_known(arguments.only);
  const fs::path folder = arguments.out;
  prepare_output_folder(folder);
  int broken = 0;
  for (const ValidatedPart& part : parts) {
    const auto& only = arguments.only;
    if (!only.empty() && std::find(only.begin(), only.end(), part.name) == only.end()) continue;
    const ValidationPage page = part.page(UNDERSTORY_SOURCE_DIR);
    write_page(page, folder);
    broken += broken_checks(page);
    fmt::print("{}{}\n", check_lines(page), (folder / (page.file + ".md")).string());
    std::fflush(stdout);
  }
  if (broken > 0) fmt::print("{} broken\n", broken);
  return broken > 0 ? 1 : 0;
}

}  // namespace
}  // namespace understory

/// Measures the models against what is known and writes the pages. Exit status: 0, or 1 where a tolerance is
/// broken, 2 for bad input, 3 where the machine failed.
int main(int argc, char** argv) {
  using namespace understory;
  CLI::App app("Measures the models against what is known; writes pages with plots");
  ValidateArguments arguments;
  app.add_option("--out", arguments.out, "folder of the pages")->capture_default_str();
  app.add_option("--only", arguments.only, "these parts and no others, for instance aircraft")
      ->delimiter(',');
  try {
    app.parse(argc, argv);
    return run_validate(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const ScenarioError& error) {
    fmt::print(stderr, "understory_validate: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "understory_validate: {}\n", error.what());
    return 3;
  }
}
