#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The command line: what each command takes, read with CLI11, which this header does not include, because it
/// compiles slowly.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace understory {

/// How every command ends; if a signal stopped it, with 128 and the signal's number (130: SIGINT, 143:
/// SIGTERM).
enum ExitStatus {
  exit_goal = 0,
  exit_not_goal = 1,
  exit_bad_input = 2,
  exit_machine_failed = 3,
  exit_undecided = 4
};

/// An option as help, manual and completion show it.
struct OptionText {
  std::string name;         ///< "--out"; "INPUT" for an argument without a dash
  std::string placeholder;  ///< FILE, FOLDER, SCENARIO, RIG, a|b ...: what completion offers; empty: a flag
  std::string meaning;
  std::string standard = {};            ///< its default value; empty: nothing to show
  std::vector<std::string> words = {};  ///< all that may be given; empty: anything
  bool required = false;
};

/// A command as help, manual and completion show it.
struct CommandText {
  std::string name, purpose;
  std::string example;           ///< a line that works
  std::string success = "done";  ///< meaning of status 0
  std::string failure = {};      ///< meaning of status 1; empty: the command never ends so
  std::string undecided = {};    ///< the same of status 4
};

/// One command: its options, what it does. Every option refuses an empty value. The variable that an option
/// sets must outlive the parsing.
class Command {
 public:
  Command(CLI::App& app, CommandText text);

  /// An option just added.
  struct Added {
    Command& command;
    CLI::Option& option;
    OptionText& text;
    const Added& required() const;
    const Added& excludes(const Added& other) const;
    /// The option is refused without the other.
    const Added& needs(const Added& other) const;
  };

  Added text(std::string name, std::string placeholder, std::string& value, std::string meaning);
  /// May be given again and again; an option takes `least` words each time (0: one), an argument without a
  /// dash `least` to `most`.
  Added texts(std::string name, std::string placeholder, std::vector<std::string>& values,
              std::string meaning, int least = 0, int most = 1 << 29);
  Added whole(std::string name, int& value, int least, int most, std::string meaning);
  Added number(std::string name, double& value, double least, double most, std::string meaning);
  Added number(std::string name, std::optional<double>& value, double least, double most,
               std::string meaning);
  /// A flag that may bear a number: --walk, --walk=2.
  Added flag_or_number(std::string name, double number_of_flag, std::optional<double>& value, double least,
                       double most, std::string meaning);
  Added flag(std::string name, bool& value, std::string meaning);
  template <typename T, std::size_t N>
  Added choice(std::string name, T& value, const std::array<std::pair<std::string_view, T>, N>& names,
               std::string meaning) {
    OptionText text{std::move(name), "", std::move(meaning)};
    for (const auto& [word, meant] : names) {
      text.words.emplace_back(word);
      if (meant == value) text.standard = word;
    }
    return add(std::move(text), [&value, &names](const std::string& given) {
      for (const auto& [word, meant] : names)
        if (word == given) value = meant;
    });
  }

  /// What the command does; gives the exit status.
  void runs(std::function<int()> run) { run_ = std::move(run); }

  const CommandText& text() const { return text_; }
  const std::deque<OptionText>& options() const { return options_; }
  bool hidden() const { return hidden_; }
  /// Keeps the command out of help, manual and completion.
  void hide();
  /// Unknown arguments are no error.
  void takes_anything();

 private:
  friend class CommandLine;
  using Take = std::function<void(const std::string&)>;
  Added add(OptionText text, Take take, int most = 1);

  CLI::App& app_;
  CommandText text_;
  std::deque<OptionText> options_;  ///< in the order they were added
  std::function<int()> run_;
  bool hidden_ = false;
};

/// The program's commands.
class CommandLine {
 public:
  /// `version`: called when the version is to be printed.
  explicit CommandLine(std::function<std::string()> version);
  ~CommandLine();

  Command& add(CommandText text);
  const std::deque<Command>& commands() const { return commands_; }

  /// Reads the arguments and runs the command they name; its status. Throws ScenarioError in one line if they
  /// are invalid.
  int run(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
  std::deque<Command> commands_;
};

/// The lines of help and manual about how a command ends.
std::vector<std::pair<std::string, std::string>> exit_statuses(const CommandText& command);

/// understory(1), troff source, of everything that is not hidden.
std::string manual_page(const std::deque<Command>& commands);
/// A bash script that completes commands, options and their values.
std::string bash_completion(const std::deque<Command>& commands);

}  // namespace understory
