#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/validation/aircraft_page.hpp"
#include "scenarios/validation/estimator_page.hpp"
#include "scenarios/validation/mismatch_page.hpp"
#include "scenarios/validation/page.hpp"

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
  std::string out = "validation";
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
    const ValidationPage page = part.page(data_root());
    write_page(page, folder);
    broken += broken_checks(page);
    fmt::print("{}{}\n", check_lines(page), (folder / (page.file + ".md")).string());
    std::fflush(stdout);
  }
  if (broken > 0) fmt::print("{} broken\n", broken);
  return broken > 0 ? exit_not_goal : exit_goal;
}

}  // namespace

void add_validate_command(CommandLine& line) {
  const auto arguments = std::make_shared<ValidateArguments>();
  Command& command =
      line.add({"validate", "measure the models against what is known; write pages with plots",
                "understory validate --only aircraft", "every tolerance is kept", "one is broken"});
  command.text("--out", "FOLDER", arguments->out, "of the pages (docs: those of the documentation)");
  command.texts("--only", "PART", arguments->only, "this part and no other, for instance aircraft");
  command.runs([arguments] { return run_validate(*arguments); });
}

}  // namespace understory
