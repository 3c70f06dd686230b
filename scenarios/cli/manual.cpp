#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenarios/cli/command_line.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/result_kinds.hpp"

namespace understory {
namespace {

/// Text as troff reads it: no line of it a request, no dash a hyphen.
std::string troff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (out.empty() && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

bool is_positional(const OptionText& option) { return !option.name.starts_with('-'); }

std::string synopsis(const Command& command) {
  std::string line = fmt::format(".B understory {}\n", troff(command.text().name));
  for (const OptionText& option : command.options()) {
    if (is_positional(option))
      line += (option.required ? ".I " : ".RI [ ") + troff(option.name) + (option.required ? "\n" : " ]\n");
    else if (option.required)
      line += fmt::format(".BI {} \" {}\"\n", troff(option.name), troff(option.placeholder));
  }
  return line + ".RI [ options ]\n";
}

std::string option_entry(const OptionText& option) {
  std::string text = ".TP\n";
  if (is_positional(option))
    text += fmt::format(".I {}\n", troff(option.name));
  else if (option.placeholder.empty())
    text += fmt::format(".B {}\n", troff(option.name));
  else
    text += fmt::format(".BI {} \" {}\"\n", troff(option.name), troff(option.placeholder));
  text += troff(option.meaning);
  if (!option.standard.empty()) text += troff(fmt::format(" (default: {})", option.standard));
  return text + "\n";
}

std::string section_of(const Command& command) {
  const CommandText& text = command.text();
  std::string page =
      fmt::format(".SS {}\n{}.PP\n{}.\n", troff(text.name), synopsis(command), troff(text.purpose));
  for (const OptionText& option : command.options()) page += option_entry(option);
  if (const ResultKind* results = results_of(text.name))
    page += fmt::format(".PP\nFiles in the results folder: {}\n",
                        troff(fmt::format("{}", fmt::join(results->patterns, " "))));
  page += ".PP\nExit status:\n";
  for (const auto& [status, meaning] : exit_statuses(text))
    if (status == "0" || status == "1") page += fmt::format("{}: {}. ", status, troff(meaning));
  page += fmt::format("\n.PP\nExample:\n.PP\n.EX\n{}\n.EE\n", troff(text.example));
  return page;
}

/// What completion offers for the value after `option`: words, or bash's own action.
std::string offer(const OptionText& option) {
  if (!option.words.empty())
    return fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", fmt::join(option.words, " "));
  if (option.placeholder == "SCENARIO" || option.placeholder == "RIG")
    return fmt::format(
        "COMPREPLY=($(compgen -f -W \"$(understory completion {} 2>/dev/null)\" -- \"$word\"))",
        option.placeholder);
  if (option.placeholder == "FOLDER") return "COMPREPLY=($(compgen -d -- \"$word\"))";
  if (option.placeholder == "FILE") return "COMPREPLY=($(compgen -f -- \"$word\"))";
  return "COMPREPLY=()";
}

}  // namespace

std::string manual_page(const std::deque<Command>& commands) {
  std::string page = fmt::format(
      ".TH UNDERSTORY 1 \"\" \"understory {}\" \"User Commands\"\n"
      ".SH NAME\nunderstory \\- a simulated delta wing flies through forests on its own stereo vision\n"
      ".SH SYNOPSIS\n.B understory\n.I command\n.RI [ arguments ]\n.br\n.B understory \\-\\-version\n"
      ".SH DESCRIPTION\n"
      "Understory flies a small delta wing through simulated forests on its own stereo vision, headless, on "
      "a CPU,\nthe same way every time. It detects obstacles in recorded stereo images, too.\n"
      ".SH COMMANDS\n",
      troff(understory_version));
  for (const Command& command : commands)
    if (!command.hidden()) page += section_of(command);
  page += ".SH EXIT STATUS\n";
  for (const auto& [status, meaning] : exit_statuses({"", "", "", "done, or the goal was reached",
                                                      "the goal was not reached, or the result is negative",
                                                      "not enough flights for a verdict (gate)"}))
    page += fmt::format(".TP\n.B {}\n{}\n", status, troff(meaning));
  page +=
      ".SH ENVIRONMENT\n"
      ".TP\n.B UNDERSTORY_ROOT\nfolder with models/ and scenarios/, in place of those installed with the "
      "program\n"
      ".TP\n.B UNDERSTORY_OSMESA, UNDERSTORY_EGL\nlibrary files that draw, in place of libOSMesa and libEGL\n"
      ".TP\n.B LP_NUM_THREADS\nthreads that Mesa's software renderer draws with (default: none of its own)\n";
  return page;
}

std::string bash_completion(const std::deque<Command>& commands) {
  std::string names, cases;
  for (const Command& command : commands) {
    if (command.hidden()) continue;
    names += (names.empty() ? "" : " ") + command.text().name;
    std::string options = "--help", values, positional;
    for (const OptionText& option : command.options()) {
      if (is_positional(option)) {
        positional = offer(option);
        continue;
      }
      options += " " + option.name;
      if (!option.placeholder.empty())
        values += fmt::format("        {}) {}; return ;;\n", option.name, offer(option));
    }
    cases += fmt::format(
        "    {})\n      case $before in\n{}      esac\n"
        "      if [[ $word == -* ]]; then COMPREPLY=($(compgen -W '{}' -- \"$word\")); return; fi\n"
        "      {} ;;\n",
        command.text().name, values, options, positional.empty() ? "COMPREPLY=()" : positional);
  }
  return fmt::format(
      "# bash completion for understory, made by: understory completion bash\n"
      "_understory() {{\n"
      "  local word=$2 before=$3\n"
      "  compopt -o filenames 2>/dev/null\n"
      "  if ((COMP_CWORD == 1)); then COMPREPLY=($(compgen -W '{} --help --version' -- \"$word\")); return; "
      "fi\n"
      "  case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "}}\n"
      "complete -F _understory understory\n",
      names, cases);
}

}  // namespace understory
