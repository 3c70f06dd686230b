#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace understory::support {

/// A row of tables/*.txt: what somebody does wrong, or what the surroundings do to them, and how it must end.
struct Misuse {
  std::string place;    ///< "options.txt:12"
  std::string setup;    ///< of the shell, in an empty folder
  std::string command;  ///< of the shell there; $U is the program, $F a folder with results (fixtures below)
  int status = 2;
  std::vector<std::string> names;    ///< that the one line on standard error must hold: file, line, key
  std::vector<std::string> changed;  ///< paths (with '*') that may come, go or change; nothing else may
};

/// Reads "setup :: command :: status :: names :: changed"; '#' begins a comment line.
std::vector<Misuse> read_misuses(const std::filesystem::path& file);

/// Every file, folder and link below `folder` with what it holds.
std::map<std::string, std::string> tree_of(const std::filesystem::path& folder);

/// Results to misuse, made when a row first asks for them and kept while the test runs: $F/run, $F/campaign,
/// $F/recording, $F/tuning, $F/evaluation.
class Fixtures {
 public:
  explicit Fixtures(std::filesystem::path folder) : folder_(std::move(folder)) {}
  const std::filesystem::path& folder() const { return folder_; }
  void make_those_in(const std::string& text);

 private:
  std::filesystem::path folder_;
};

/// What is wrong with how it ended; empty: nothing.
std::string fault_of(const Misuse& misuse, Fixtures& fixtures, const std::filesystem::path& folder);

}  // namespace understory::support
