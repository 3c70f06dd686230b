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

/// This very program: its version, its identity and processes that run it.
namespace understory {

extern const char* const understory_version;  ///< "0.1.0"
/// The commit it was built from: "a1b2c3d4e5", with "-dirty" if files were changed since; "unknown" without
/// git and in other programs. main() and the Python module set it to commit_of_this_build, which they alone
/// link.
extern const char* understory_commit;
extern const char* const commit_of_this_build;

/// Digest of the program's file. Equal programs give equal results.
std::string program_digest();
/// Digest of the contents of the shared libraries that this process has mapped: others may give other
/// results.
std::string mapped_libraries_digest();
/// Digest of bytes; of a file's contents, or of nothing if it cannot be read.
std::string digest_of_text(std::string_view text);
std::string digest_of_file(const std::filesystem::path& file);
/// What decides flights beside their scenarios: names ("program", "libraries", "models", "rig long") with a
/// digest of each. Equal identities on one machine fly equal flights. The processor is no part of it: the
/// nodes of a cluster differ, and a campaign over them is still one (docs/decisions/010-campaigns.md).
using Identity = std::vector<std::pair<std::string, std::string>>;

/// The first name whose digest differs, or which only one has; empty where both are equal.
std::string difference_of(const Identity& one, const Identity& other);

/// The model of this machine's processor, as its kernel calls it; empty if unknown.
std::string processor_model();
/// Repairs faults of a process's environment that main() cannot report: opens closed standard descriptors,
/// sets SIGCHLD to its default, and ignores SIGXFSZ, so that a write fails instead.
void repair_surroundings();

/// A process that has ended.
struct EndedProcess {
  pid_t pid = 0;
  int wait_status = 0;        ///< as wait() gives it
  double cpu_s = 0;           ///< of all its threads, in the kernel too
  double peak_memory_mb = 0;  ///< 10^6 bytes, resident
};

/// Starts this program with `arguments` (without the program's name), in a process group of its own, so that
/// Ctrl-C reaches us alone. `at_our_end`: the signal that it gets when we end. `log`: takes its standard
/// error, its output is discarded; empty: it has ours. `program`: another one than this. Throws
/// MachineError if it cannot be started.
pid_t start_this_program(const std::vector<std::string>& arguments, int at_our_end,
                         const std::filesystem::path& log = {}, const std::filesystem::path& program = {});

/// What a program said last on its standard error, which `log` took: without the program's name.
std::string last_line_of(const std::filesystem::path& log);

/// Waits for `pid`, or with -1 for any child; WNOHANG in `options` only checks: pid 0 while it runs.
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
