#include <CLI/CLI.hpp>

#include "scenarios/cli/commands.hpp"

namespace understory {

void add_scenario_options(CLI::App& command, ScenarioArguments& arguments) {
  command.add_option("scenario", arguments.scenario, "a scenario file, or a name from scenarios/library")
      ->required();
  command
      .add_option("--with", arguments.with,
                  "a file of the scenario's keys that go over its own: what tune leaves")
      ->allow_extra_args(false)
      ->trigger_on_parse(false);
  add_settings_option(command, arguments.settings);
}

void add_settings_option(CLI::App& command, std::vector<std::string>& settings) {
  command.add_option("--set", settings, "key=value, as in the scenario file: forest.length_m=30")
      ->allow_extra_args(false)
      ->trigger_on_parse(false);
}

void add_renderer_option(CLI::App& command, RendererKind& renderer) {
  std::vector<std::string> words;
  for (const auto& [word, kind] : renderer_names) words.emplace_back(word);
  command
      .add_option_function<std::string>(
          "--renderer",
          [&renderer](const std::string& given) {
            for (const auto& [word, kind] : renderer_names)
              if (word == given) renderer = kind;
          },
          "who draws: osmesa (software, the default), egl (a GPU where there is one), auto (a GPU, else "
          "osmesa)")
      ->check(CLI::IsMember(words));
}

}  // namespace understory
