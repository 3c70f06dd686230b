#include "scenarios/scenario/plugin.hpp"

#include <dlfcn.h>
#include <elf.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <deque>
#include <exception>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "perception/io/text_file.hpp"
#include "scenarios/config/keys.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// The first line in which the stamps differ, as "needs ..., has ..."; empty where they are equal.
std::string difference_of(const std::string& ours, const std::string& theirs) {
  std::istringstream needed(ours), given(theirs);
  std::string one, other;
  while (std::getline(needed, one)) {
    if (!std::getline(given, other)) other = "nothing";
    if (one != other) return fmt::format("was built for '{}', this program needs '{}'", other, one);
  }
  return "";
}

template <typename Function>
Function function_in(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

[[noreturn]] void refuse(const std::string& file, const std::string& asked_by, const std::string& why) {
  throw ScenarioError(fmt::format("{}: {}: {}", asked_by, file, why));
}

using AddParts = void (*)(Parts&);

/// Opens a library. Gives the function that adds its parts.
AddParts opened_library(const std::string& file, const std::string& asked_by) {
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw ScenarioError(fmt::format("{}: cannot be loaded: {}", asked_by, dlerror()));
  const auto stamp = function_in<const char* (*)()>(library, "understory_plugin_stamp");
  const auto add = function_in<AddParts>(library, "understory_plugin_add");
  if (stamp == nullptr || add == nullptr)
    refuse(file, asked_by, "is not a plug-in: it has no UNDERSTORY_PLUGIN (docs/integrate.md)");
  const char* theirs = stamp();
  if (const std::string difference = difference_of(plugin_stamp(), theirs != nullptr ? theirs : "");
      !difference.empty())
    refuse(file, asked_by, difference + "; build it again with this version's understory_add_plugin");
  return add;
}

/// Pages that a file has no more end the process that asks for them, perhaps only in flight.
void require_whole_library(const std::string& file, const std::string& asked_by) {
  std::ifstream stream(file, std::ios::binary);
  Elf64_Ehdr head{};
  stream.read(reinterpret_cast<char*>(&head), sizeof head);
  std::vector<Elf64_Phdr> segments(std::memcmp(head.e_ident, ELFMAG, SELFMAG) == 0 ? head.e_phnum : 0);
  stream.seekg(static_cast<std::streamoff>(head.e_phoff));
  stream.read(reinterpret_cast<char*>(segments.data()),
              static_cast<std::streamsize>(segments.size() * sizeof(Elf64_Phdr)));
  std::uint64_t needed = head.e_shoff + std::uint64_t{head.e_shnum} * head.e_shentsize;
  for (const Elf64_Phdr& segment : segments) needed = std::max(needed, segment.p_offset + segment.p_filesz);
  const std::uintmax_t size = fs::file_size(file);
  if (!segments.empty() && needed > size)
    refuse(file, asked_by,
           fmt::format("is cut off: its headers speak of {} bytes, it has {}; build or copy it again", needed,
                       size));
}

/// A damaged library may end the process that loads it: a child goes first.
void try_library(const std::string& file, const std::string& asked_by) {
  constexpr int survived = 42, longest_s = 20;
  const pid_t child = fork();
  if (child == 0) {
    for (const int signal : {SIGABRT, SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
    const int nothing = open("/dev/null", O_RDWR);
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, standard);
    alarm(longest_s);
    try {
      Parts more = parts();
      opened_library(file, asked_by)(more);
    } catch (...) {  // told where it is loaded
    }
    _exit(survived);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return;  // then without
  const bool is_killed = WIFSIGNALED(status);
  if (is_killed || WEXITSTATUS(status) != survived)
    refuse(
        file, asked_by,
        fmt::format("ends the process that loads it ({}): it is damaged; build it again",
                    is_killed ? strsignal(WTERMSIG(status)) : fmt::format("status {}", WEXITSTATUS(status))));
}

/// Opens Python, where that has not been done. libpython's names are made global, which numpy's libraries
/// need.
std::function<void(Parts&)> opened_python(const std::string& file, const std::string& text,
                                          const std::string& asked_by, std::vector<FileConfig>& imported) {
  if (python_loader() == nullptr) {
    void* module = dlopen("understory_python.so", RTLD_NOW | RTLD_GLOBAL);
    const char* error = module == nullptr ? dlerror() : nullptr;
    const auto start =
        module == nullptr ? nullptr : function_in<void (*)()>(module, "understory_start_python");
    if (start == nullptr)
      throw MachineError(fmt::format("{}: {}: plug-ins in Python need the package python3-understory: {}",
                                     asked_by, file, error != nullptr ? error : "its module is broken"));
    start();
  }
  return [&](Parts& parts) {
    for (const std::string& module : python_loader()(file, text, parts))
      imported.push_back({module, digest_of_file(module)});
  };
}

/// Adds the parts of a plug-in, all or none.
void add_parts(const std::function<void(Parts&)>& add, const std::string& file, const std::string& asked_by) {
  Parts more = parts();
  try {
    add(more);
  } catch (const MachineError&) {
    throw;
  } catch (const std::exception& error) {
    refuse(file, asked_by, error.what());
  } catch (...) {
    refuse(file, asked_by, "threw what is no std::exception");
  }
  const std::vector<Key> keys = keys_of(Scenario());
  const auto mark = [&](auto& list, const auto& before, const std::string& group) {
    for (std::size_t i = before.all().size(); i < list.all().size(); ++i) {
      auto& part = list.all()[i];
      part.plugin = file;
      // Its own keys would stand there.
      const std::string name = group + part.name;
      if (std::ranges::any_of(keys, [&](const Key& key) {
            return key.name.starts_with(name) && key.name.find_first_of(".[", name.size()) == name.size();
          }))
        refuse(file, asked_by, "the name '" + part.name + "' is taken by the keys " + name);
    }
    return list.all().size() - before.all().size();
  };
  const std::size_t added = mark(more.detectors, parts().detectors, "perception.") +
                            mark(more.state_sources, parts().state_sources, "estimation.") +
                            mark(more.planners, parts().planners, "autopilot.") +
                            mark(more.courses, parts().courses, "");
  if (added == 0) refuse(file, asked_by, "adds no part");
  // A part that is being made may load a plug-in: its table stays.
  static std::deque<Parts> before;
  before.push_back(std::exchange(parts(), std::move(more)));
}

void require_unchanged(const std::string& file, const std::string& hash, const std::string& asked_by) {
  if (digest_of_file(file) != hash)
    refuse(file, asked_by,
           "has changed since this process loaded it, and cannot be loaded again: start anew");
}

}  // namespace

PythonLoader& python_loader() {
  static PythonLoader loader = nullptr;
  return loader;
}

std::vector<std::string>& given_plugins() {
  static std::vector<std::string> files;
  return files;
}

const Plugin& load_plugin(const fs::path& file, const std::string& asked_by) {
  static std::deque<Plugin> loaded;  // references to its entries stay valid
  std::error_code error;
  const fs::path found = fs::canonical(file, error);
  if (error)
    throw ScenarioError(fmt::format("{}: {}: {}", asked_by, fs::absolute(file).string(), error.message()));
  for (const Plugin& one : loaded) {
    if (one.file != found) continue;
    require_unchanged(one.file, one.hash, asked_by);
    for (const FileConfig& module : one.imported) require_unchanged(module.file, module.hash, asked_by);
    return one;
  }
  static bool is_loading = false;
  if (std::exchange(is_loading, true))
    refuse(found, asked_by, "a plug-in cannot load another: give both to --plugin, or to load_plugin()");
  const std::unique_ptr<bool, void (*)(bool*)> loading(&is_loading, [](bool* flag) { *flag = false; });
  if (!fs::is_regular_file(found))
    throw ScenarioError(
        fmt::format("{}: {}: must be a shared library or a Python file", asked_by, found.string()));
  Plugin plugin{found.string(), "", {}};
  if (found.extension() == ".py") {
    const std::string text = read_file(found, std::size_t{16} << 20);
    plugin.hash = digest_of_text(text);
    add_parts(opened_python(plugin.file, text, asked_by, plugin.imported), plugin.file, asked_by);
  } else {
    plugin.hash = digest_of_file(found);
    require_whole_library(plugin.file, asked_by);
    try_library(plugin.file, asked_by);
    const AddParts add = opened_library(plugin.file, asked_by);
    require_unchanged(plugin.file, plugin.hash, asked_by);
    add_parts(add, plugin.file, asked_by);
  }
  loaded.push_back(std::move(plugin));
  return loaded.back();
}

}  // namespace understory
