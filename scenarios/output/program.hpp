#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// This very program.
namespace understory {

extern const char* const understory_version;  ///< "0.1.0"
/// What it was built from: "a1b2c3d4e5", "-dirty" behind it where files were changed since; "unknown" where
/// there was no git, and in programs of others. main() and the Python module set it to the second, which they
/// alone are linked with.
extern const char* understory_commit;
extern const char* const commit_of_this_build;

/// Of the program's file. Equal programs give equal results.
std::string program_digest();
/// Of the shared libraries that this process has mapped, by their files' contents: others may give other
/// results.
std::string mapped_libraries_digest();
/// Of bytes; of a file's contents, or of nothing where it cannot be read.
std::string digest_of_text(std::string_view text);
std::string digest_of_file(const std::filesystem::path& file);
/// What decides flights beside their scenarios: names ("program", "libraries", "models", "rig long") with a
/// digest of each. Equal identities on one machine fly equal flights. The processor is no part of it: the
/// nodes of a cluster differ, and a campaign over them is still one (docs/decisions/010-campaigns.md).
using Identity = std::vector<std::pair<std::string, std::string>>;

/// The first name whose digest differs, or which only one has; empty where both are equal.
std::string difference_of(const Identity& one, const Identity& other);

/// The model of this machine's processor, as its kernel calls it; empty where it does not.
std::string processor_model();
/// What goes wrong with a process's surroundings before main() can complain: standard descriptors that are
/// not open, SIGCHLD ignored by the parent, SIGXFSZ, which would kill where a write can fail.
void repair_surroundings();

/// A process that has ended.
struct EndedProcess {
  pid_t pid = 0;
  int wait_status = 0;        ///< as wait() gives it
  double cpu_s = 0;           ///< of all its threads, in the kernel too
  double peak_memory_mb = 0;  ///< 10^6 bytes, resident
};

/// Starts this program with `arguments` (without the program's name), in a process group of its own: Ctrl-C
/// is ours to answer. `at_our_end`: the signal that it gets then. `log`: takes its standard error, its output
/// goes nowhere; empty: both are ours. Throws MachineError where it cannot be started.
pid_t start_this_program(const std::vector<std::string>& arguments, int at_our_end,
                         const std::filesystem::path& log = {});

/// What a program said last on its standard error, which `log` took: without the program's name.
std::string last_line_of(const std::filesystem::path& log);

/// Waits for `pid`, or with -1 for any child; with WNOHANG in `options` only looks: pid 0 where it runs yet.
EndedProcess wait_for_process(pid_t pid, int options = 0);

/// Runs copies of this very program, a few at a time, so that a flight that crashes or hangs ends its own
/// process alone.
class ProgramProcesses {
 public:
  /// Called with the tag of a process and its exit status (128 + signal where it was killed).
  using OnEnd = std::function<void(std::uint64_t tag, int status, const EndedProcess& process)>;

  ProgramProcesses(int maximum_count, OnEnd on_end)
      : maximum_count_(maximum_count), on_end_(std::move(on_end)) {}

  /// Starts this program with `arguments` (without the program's name); first waits where all places are
  /// taken. Throws MachineError where it cannot be started.
  /// `log` as for start_this_program().
  void start(std::uint64_t tag, const std::vector<std::string>& arguments,
             const std::filesystem::path& log = {});
  void wait_for_all();

 private:
  void wait_for_one();

  int maximum_count_;
  OnEnd on_end_;
  std::map<pid_t, std::uint64_t> running_;
};

}  // namespace understory
