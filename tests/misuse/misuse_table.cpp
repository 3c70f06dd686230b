#include "tests/misuse/misuse_table.hpp"

#include <fnmatch.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "tests/support/temporary_folder.hpp"

namespace understory::support {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> parts_of(const std::string& line) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 2) {
    end = line.find("::", begin);
    const std::string part = line.substr(begin, end == std::string::npos ? end : end - begin);
    const std::size_t first = part.find_first_not_of(' '), last = part.find_last_not_of(' ');
    parts.push_back(first == std::string::npos ? "" : part.substr(first, last - first + 1));
  }
  return parts;
}

std::vector<std::string> words_in(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// stopped SIGNAL FILES COMMAND...: runs it, and sends the signal when there are files that match.
constexpr const char* stopped =
    "stopped() { local s=$1 e=$2; shift 2; \"$@\" & local p=$!; until compgen -G \"$e\" >/dev/null || "
    "! kill -0 $p 2>/dev/null; do sleep 0.02; done; kill -$s $p; wait $p; }\n";

/// In `folder`, what it prints beside it.
int shell(const std::string& text, const fs::path& folder, const fs::path& fixtures) {
  const std::string script = "export U='" UNDERSTORY_BINARY "' F='" + fixtures.string() +
                             "' SOURCE='" UNDERSTORY_SOURCE_DIR "'\n" + stopped + "cd '" + folder.string() +
                             "' || exit 99\n{ " + text + "\n} >'" + folder.string() + ".out' 2>'" +
                             folder.string() + ".err'\n";
  const fs::path file = folder.string() + ".sh";
  std::ofstream(file) << script;
  const int status = std::system(("exec timeout 3600 bash '" + file.string() + "'").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool matches(const std::string& path, const std::vector<std::string>& patterns) {
  return std::ranges::any_of(
      patterns, [&](const std::string& pattern) { return fnmatch(pattern.c_str(), path.c_str(), 0) == 0; });
}

std::string changes_between(const std::map<std::string, std::string>& before,
                            const std::map<std::string, std::string>& after, const Misuse& misuse) {
  for (const auto& [path, content] : before) {
    const auto now = after.find(path);
    if (!matches(path, misuse.changed) && (now == after.end() || now->second != content))
      return path + (now == after.end() ? " is gone" : " has changed");
  }
  for (const auto& [path, content] : after)
    if (!before.contains(path) && !matches(path, misuse.changed)) return path + " was left behind";
  return "";
}

}  // namespace

std::vector<Misuse> read_misuses(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<Misuse> misuses;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> parts = parts_of(line);
    if (parts.size() < 3)
      throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": too few columns");
    Misuse misuse{file.filename().string() + ":" + std::to_string(number),
                  parts[0],
                  parts[1],
                  std::stoi(parts[2]),
                  {},
                  {}};
    if (parts.size() > 3) misuse.names = words_in(parts[3]);
    if (parts.size() > 4) misuse.changed = words_in(parts[4]);
    misuses.push_back(std::move(misuse));
  }
  return misuses;
}

std::map<std::string, std::string> tree_of(const fs::path& folder) {
  std::map<std::string, std::string> tree;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string path = entry.path().lexically_relative(folder).string();
    if (entry.is_symlink())
      tree[path] = "link to " + fs::read_symlink(entry.path()).string();
    else
      tree[path] = entry.is_regular_file() ? "file " + content_of(entry.path()) : "other";
  }
  return tree;
}

void Fixtures::make_those_in(const std::string& text) {
  const std::pair<const char*, const char*> all[] = {
      {"run", "$U fly clear --set forest.length_m=1 --quiet --out run"},
      {"recording",
       "printf '0 0 0 3 0 0 0 1\\n0.1 1 0 3 0 0 0 1\\n' > path.tum; $U record clear --path path.tum --quiet "
       "--out recording"},
      {"campaign",
       "printf 'scenario: clear\\nseeds: 1..2\\noverrides: [{name: short, set: {forest.length_m: 1}}]\\n' > "
       "campaign.yaml; "
       "$U campaign campaign.yaml --out campaign"},
      {"tuning",
       "printf 'scenario: clear\\nparameters: {autopilot.flight_model.cruise_speed_mps: {from: 9, to: 12}}\\n"
       "objective: {maximize: progress}\\nsearch: {method: random, trials: 1, sensitivity: 2}\\nover: "
       "flights\\n"
       "training: 1\\nvalidation: 2\\n' > tune.yaml; $U tune tune.yaml --out tuning"},
      {"evaluation", "$U evaluate recording --out evaluation"}};
  for (const auto& [name, how] : all) {
    if (text.find(std::string("$F/") + name) == std::string::npos || fs::exists(folder_ / name)) continue;
    if (name == std::string("evaluation")) make_those_in("$F/recording");
    const int status = shell(how, folder_, folder_);
    if (status > 1)
      throw std::runtime_error(std::string(name) +
                               " could not be made: " + content_of(folder_.string() + ".err"));
  }
}

std::string fault_of(const Misuse& misuse, Fixtures& fixtures, const fs::path& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  fixtures.make_those_in(misuse.setup + misuse.command);
  if (const int status = shell(misuse.setup.empty() ? ":" : misuse.setup, folder, fixtures.folder());
      status != 0)
    return "the setup ended with " + std::to_string(status) + ": " + content_of(folder.string() + ".err");
  const auto before = tree_of(folder);
  const int status = shell(misuse.command, folder, fixtures.folder());
  const std::string said = content_of(folder.string() + ".err");
  const auto ended = [&](const std::string& how) {
    return how + "\n  " + misuse.command + "\n  " + said.substr(0, 2000);
  };
  if (status != misuse.status)
    return ended("status " + std::to_string(status) + " instead of " + std::to_string(misuse.status));
  if (said.find("internal fault") != std::string::npos) return ended("an internal fault");
  const bool is_heard = misuse.command.find("2>") == std::string::npos;
  if (status >= 2 && is_heard) {
    if (std::ranges::count(said, '\n') != 1 || !said.starts_with("understory: "))
      return ended("not one line of the program's");
    if (said.size() > 6000) return ended("a line of " + std::to_string(said.size()) + " characters");
  }
  for (const std::string& name : misuse.names)
    if (said.find(name) == std::string::npos) return ended("'" + name + "' is not named");
  const std::string changes = changes_between(before, tree_of(folder), misuse);
  return changes.empty() ? "" : ended(changes);
}

}  // namespace understory::support
