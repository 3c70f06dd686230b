#include "scenarios/cli/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "perception/io/text_table.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/result_kinds.hpp"

namespace understory {
namespace {

template <typename Number>
Number number_given(const std::string& name, const std::string& given, Number least, Number most) {
  const auto value = number_in<Number>(given);
  if (!value || *value < least || *value > most)
    throw ScenarioError(fmt::format("{} {}: must be a {} from {} to {}", name, given,
                                    std::is_integral_v<Number> ? "whole number" : "number", least, most));
  return *value;
}

/// "--seed=" in front of another argument would take that for its value.
void refuse_empty_assignments(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.starts_with("--") && argument.find('=') == argument.size() - 1)
      throw ScenarioError(fmt::format("{} needs a value", argument));
  }
}

/// CLI11's errors in our words.
void refuse_arguments(const Command& command, const CLI::ParseError& error) {
  const std::string& name = command.text().name;
  const auto about = [&](const OptionText& option) {
    return std::string(error.what()).starts_with(option.name) || option.name == error.what();
  };
  const auto option = std::ranges::find_if(command.options(), about);
  if (option == command.options().end()) return;
  const std::string text = error.what();
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    throw ScenarioError(
        fmt::format("{} requires {} {}: {}", name, option->name, option->placeholder, option->meaning));
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    const bool too_many = text.find("received") != std::string::npos;
    throw ScenarioError(fmt::format("{} {}: {} (understory {} --help)", name, option->name,
                                    too_many ? "given too often" : "needs a value", name));
  }
  const std::string other = text.substr(std::min(text.size(), text.rfind(' ') + 1));
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
    throw ScenarioError(fmt::format("{}: {} requires {}", name, option->name, other));
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    throw ScenarioError(fmt::format("{}: {} and {} exclude each other", name, option->name, other));
}

}  // namespace

std::vector<std::pair<std::string, std::string>> exit_statuses(const CommandText& command) {
  std::vector<std::pair<std::string, std::string>> lines{{"0", command.success}};
  if (!command.failure.empty()) lines.emplace_back("1", command.failure);
  lines.emplace_back("2", "bad input");
  lines.emplace_back("3", "the machine failed: a full disk, a missing library");
  if (!command.undecided.empty()) lines.emplace_back("4", command.undecided);
  lines.emplace_back("130, 143", "stopped by SIGINT, SIGTERM");
  return lines;
}

const Command::Added& Command::Added::required() const {
  option.required();
  text.required = true;
  return *this;
}

const Command::Added& Command::Added::needs(const Added& other) const {
  option.needs(&other.option);
  return *this;
}

const Command::Added& Command::Added::excludes(const Added& other) const {
  option.excludes(&other.option);
  return *this;
}

Command::Command(CLI::App& app, CommandText text) : app_(app), text_(std::move(text)) {
  std::string footer = "Example:\n  " + text_.example + "\n";
  if (const ResultKind* results = results_of(text_.name))
    footer += fmt::format("Files in the results folder:\n  {}\n", fmt::join(results->patterns, " "));
  footer += "Exit status:\n";
  for (const auto& [status, meaning] : exit_statuses(text_))
    footer += fmt::format("  {:<10}{}\n", status, meaning);
  footer.pop_back();
  app_.footer(footer);
}

void Command::takes_anything() { app_.allow_extras(); }

void Command::hide() {
  hidden_ = true;
  app_.group("");
}

Command::Added Command::add(OptionText text, Take take, int most) {
  OptionText& kept = options_.emplace_back(std::move(text));
  const std::string name = kept.name;
  const auto take_each = [&kept, take = std::move(take)](const std::vector<std::string>& given) {
    for (const std::string& value : given) {
      if (value.empty()) throw ScenarioError(kept.name + " needs a value");
      if (!kept.words.empty() && std::ranges::find(kept.words, value) == kept.words.end())
        throw ScenarioError(
            fmt::format("{} {}: must be one of {}", kept.name, value, fmt::join(kept.words, ", ")));
      take(value);
    }
  };
  if (!kept.words.empty()) kept.placeholder = fmt::format("{}", fmt::join(kept.words, "|"));
  CLI::Option* option = app_.add_option_function<std::vector<std::string>>(name, take_each, kept.meaning)
                            ->type_name(kept.placeholder);
  if (most == 1) option->expected(1)->allow_extra_args(false);
  if (!kept.standard.empty()) option->default_str(kept.standard);
  return {*this, *option, kept};
}

Command::Added Command::text(std::string name, std::string placeholder, std::string& value,
                             std::string meaning) {
  return add({std::move(name), std::move(placeholder), std::move(meaning), value},
             [&value](const std::string& given) { value = given; });
}

Command::Added Command::texts(std::string name, std::string placeholder, std::vector<std::string>& values,
                              std::string meaning, int least, int most) {
  const bool is_option = name.starts_with("--");
  const Added added = add(
      {std::move(name), std::move(placeholder), std::move(meaning)},
      [&values](const std::string& given) { values.push_back(given); }, most);
  if (is_option)
    added.option.expected(std::max(1, least))
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  else
    added.option.expected(std::max(1, least), most);
  if (least > 0 && !is_option) added.required();
  return added;
}

Command::Added Command::whole(std::string name, int& value, int least, int most, std::string meaning) {
  return add({name, "N", std::move(meaning), value == 0 ? "" : fmt::format("{}", value)},
             [&value, name, least, most](const std::string& given) {
               value = number_given(name, given, least, most);
             });
}

Command::Added Command::number(std::string name, double& value, double least, double most,
                               std::string meaning) {
  return add({name, "X", std::move(meaning), fmt::format("{}", value)},
             [&value, name, least, most](const std::string& given) {
               value = number_given(name, given, least, most);
             });
}

Command::Added Command::number(std::string name, std::optional<double>& value, double least, double most,
                               std::string meaning) {
  return add({name, "X", std::move(meaning)}, [&value, name, least, most](const std::string& given) {
    value = number_given(name, given, least, most);
  });
}

Command::Added Command::flag_or_number(std::string name, double number_of_flag, std::optional<double>& value,
                                       double least, double most, std::string meaning) {
  OptionText& kept = options_.emplace_back(OptionText{name, "", std::move(meaning)});
  // CLI11 rounds the numbers of flags, but not where they are text.
  const auto text = std::make_shared<std::string>();
  CLI::Option* option = app_.add_flag(fmt::format("{}{{{}}}", name, number_of_flag), *text, kept.meaning);
  option->check([&value, text, name, least, most](const std::string& given) {
    value = number_given(name, given, least, most);
    return std::string();
  });
  return {*this, *option, kept};
}

Command::Added Command::flag(std::string name, bool& value, std::string meaning) {
  OptionText& kept = options_.emplace_back(OptionText{name, "", std::move(meaning)});
  return {*this, *app_.add_flag(name, value, kept.meaning), kept};
}

CommandLine::CommandLine(std::function<std::string()> version)
    : app_(std::make_unique<CLI::App>(
          "Understory: a small delta wing flies through forests on its own stereo vision", "understory")) {
  app_->set_version_flag("--version", std::move(version), "Print version, commit and renderer");
  app_->require_subcommand(1);
  app_->footer("understory COMMAND --help explains a command, with an example and its exit status.");
}

CommandLine::~CommandLine() = default;

Command& CommandLine::add(CommandText text) {
  CLI::App* command = app_->add_subcommand(text.name, text.purpose);
  return commands_.emplace_back(*command, std::move(text));
}

int CommandLine::run(int argc, char** argv) {
  refuse_empty_assignments(argc, argv);
  std::vector<std::string> names;
  for (const Command& command : commands_)
    if (!command.hidden()) names.push_back(command.text().name);
  if (argc < 2)
    throw ScenarioError(fmt::format("no command given; the commands are {}", fmt::join(names, ", ")));
  const std::string_view first = argv[1];
  if (first.starts_with('-') && first != "--help" && first != "-h" && first != "--version")
    throw ScenarioError(
        fmt::format("{}: a command must come first{}; the commands are {}", first,
                    did_you_mean(first.substr(std::min(first.size(), first.find_first_not_of('-'))), names),
                    fmt::join(names, ", ")));
  const auto named = std::ranges::find(commands_, first, [](const Command& c) { return c.text().name; });
  if (named == commands_.end() && !first.starts_with('-'))
    throw ScenarioError(fmt::format("{}: unknown command{}; the commands are {}", first,
                                    did_you_mean(first, names), fmt::join(names, ", ")));
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    const std::string extra = app_->remaining(true).front();
    std::vector<std::string> known{"--help"};
    if (named != commands_.end())
      for (const OptionText& option : named->options_) known.push_back(option.name);
    throw ScenarioError(extra.starts_with('-')
                            ? fmt::format("{} {}: unknown option{}", first, extra,
                                          did_you_mean(extra.substr(0, extra.find('=')), known))
                            : fmt::format("{} {}: one argument too many", first, extra));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_->exit(error);
    if (named != commands_.end()) refuse_arguments(*named, error);
    throw ScenarioError(fmt::format("{} {} (see understory {} --help)", first, error.what(), first));
  }
  return named->run_();
}

}  // namespace understory
