#include "scenarios/output/signals.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <set>
#include <string_view>
#include <thread>
#include <vector>

#include "perception/io/machine_limits.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/progress_line.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};
using Actions = std::array<struct sigaction, signals.size()>;

volatile std::sig_atomic_t remembered = 0;
Actions before;
int living = 0;
std::array<int, 2> wake_pipe;
int last_words =
    STDERR_FILENO;  ///< that descriptor as it was at first: readers of files may close it a while

/// Never destroyed: the thread may still look at them while the program ends.
std::recursive_mutex& outputs = *new std::recursive_mutex;
std::set<fs::path>& unfinished = *new std::set<fs::path>;
std::set<pid_t>& children = *new std::set<pid_t>;
std::vector<fs::path>& made_folders = *new std::vector<fs::path>;  ///< innermost first

void set_actions(void (*handler)(int), Actions& former) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    sigaction(signals[i], nullptr, &former[i]);
    const bool is_nohup = signals[i] == SIGHUP && former[i].sa_handler == SIG_IGN;
    if (!is_nohup) sigaction(signals[i], &action, nullptr);
  }
}

const char* name_of(int signal) {
  if (signal == SIGINT) return "SIGINT";
  return signal == SIGTERM ? "SIGTERM" : "SIGHUP";
}

/// At once; what cannot be said is not.
void say(int descriptor, std::string_view text) {
  if (write(descriptor, text.data(), text.size()) < 0) return;
}

[[noreturn]] void wait_and_end() {
  int signal = 0;
  while (read(wake_pipe[0], &signal, sizeof signal) != sizeof signal) {
  }
  outputs.lock();  // whoever makes or names something from here on waits for ever
  for (const pid_t child : children) kill(child, SIGHUP);
  for (const pid_t child : children) waitpid(child, nullptr, 0);
  for (const fs::path& path : unfinished) {
    std::error_code error;  // the work may be clearing away, too, where it finds its folder gone
    for (int tries = 0; tries < 100 && fs::exists(fs::symlink_status(path, error)); ++tries)
      remove_unfinished(path);
  }
  remove_made_folders();
  ProgressLine::clear_any();
  const std::string line = fmt::format("understory: stopped by {}\n", name_of(signal));
  if (signal != SIGHUP) say(last_words, line);
  _exit(128 + signal);
}

}  // namespace

void end_on_signals() {
  if (pipe2(wake_pipe.data(), O_CLOEXEC) != 0)
    throw MachineError(fmt::format("no pipe to be had: {}", lacking_resource(errno)));
  last_words = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  Actions former;
  set_actions(
      [](int signal) {
        say(wake_pipe[1], {reinterpret_cast<char*>(&signal), sizeof signal});
      },
      former);
  // A fork's signals are its own, and not ours to answer.
  pthread_atfork(nullptr, nullptr, [] {
    for (const int signal : signals)
      if (struct sigaction now{}; sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_IGN)
        std::signal(signal, SIG_DFL);
  });
  std::thread(wait_and_end).detach();
}

void ends_with_us(pid_t child) {
  const auto lock = hold_outputs();
  children.insert(child);
}

void has_ended(pid_t child) {
  const auto lock = hold_outputs();
  children.erase(child);
}

StopSignals::StopSignals() {
  if (living++ > 0) return;
  remembered = 0;
  set_actions([](int signal) { remembered = signal; }, before);
}

StopSignals::~StopSignals() {
  if (--living > 0) return;
  for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before[i], nullptr);
}

int StopSignals::number() const { return remembered; }

void remove_unfinished(const fs::path& path) {
  std::error_code error;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().filename() != mark_name &&
        fs::remove_all(entry->path(), error) == static_cast<std::uintmax_t>(-1))
      return;
  if (!error || error == std::errc::not_a_directory) fs::remove_all(path, error);
}

void make_folders(const fs::path& folder, const fs::path& name) {
  std::vector<fs::path> missing;
  std::error_code error, ignored;
  const fs::path whole = fs::absolute(folder).lexically_normal();
  for (fs::path above = whole.has_filename() ? whole : whole.parent_path();
       !above.empty() && !fs::exists(above, ignored) && above != above.parent_path();
       above = above.parent_path())
    missing.push_back(above);
  const auto lock = hold_outputs();
  fs::create_directories(folder, error);
  if (error) refuse_output(name, error.value());
  const fs::file_status status = fs::status(folder, ignored);  // another program may have removed it
  if (fs::exists(status) && !fs::is_directory(status)) refuse_output(name, ENOTDIR);
  made_folders.insert(made_folders.begin(), missing.begin(), missing.end());
}

void remove_made_folders() {
  const auto lock = hold_outputs();
  std::erase_if(made_folders, [](const fs::path& folder) { return ::rmdir(folder.c_str()) == 0; });
}

Unfinished::Unfinished(fs::path path) : path_(std::move(path)) {
  const auto lock = hold_outputs();
  unfinished.insert(path_);
}

Unfinished::~Unfinished() {
  const auto lock = hold_outputs();
  unfinished.erase(path_);
  if (!is_kept_) remove_unfinished(path_);
}

void Unfinished::rename_to(const fs::path& name) {
  const auto lock = hold_outputs();
  if (std::rename(path_.c_str(), name.c_str()) != 0) refuse_output(name, errno);
  unfinished.erase(path_);
  is_kept_ = true;
}

void Unfinished::keep() {
  const auto lock = hold_outputs();
  unfinished.erase(path_);
  is_kept_ = true;
}

std::unique_lock<std::recursive_mutex> hold_outputs() { return std::unique_lock(outputs); }

}  // namespace understory
