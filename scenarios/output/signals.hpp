#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <mutex>

/// What becomes of unfinished work when SIGINT, SIGTERM or SIGHUP comes.
namespace understory {

/// From now on a signal ends the program at once, wherever it is: one line, every Unfinished removed, exit
/// status 128 and the signal's number. A thread does that, so that nothing has to ask. SIGHUP says nothing,
/// there is nobody to read it, and stays ignored where it was (nohup).
void end_on_signals();

/// `call` is made when a signal ends the program, after everything Unfinished is removed: the last one given
/// first.
void at_signal(const void* key, std::function<void()> call);
void forget_at_signal(const void* key);

/// A child process that ends with this one: a signal here hangs it up, and is waited for there.
void ends_with_us(pid_t child);
void has_ended(pid_t child);

/// While it lives, the signals end nothing: they are remembered, for work that must come to an end of its
/// own. One at a time counts, the outermost.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  bool asked() const { return number() != 0; }
  int number() const;  ///< the signal that came; 0: none
};

/// The list of a folder goes last: until then it says whose the rest is, where that could not be removed.
void remove_unfinished(const std::filesystem::path& path);

/// A file or folder that bears another name until it is whole, and is removed where the work ends before: by
/// an exception, by a signal.
class Unfinished {
 public:
  /// Nothing is made yet.
  explicit Unfinished(std::filesystem::path path);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Gives it its name, in place of a file of that name. Throws as write_whole_file does.
  void become(const std::filesystem::path& name);
  /// Leaves what is there.
  void keep();

 private:
  std::filesystem::path path_;
  bool is_kept_ = false;
};

/// Whoever holds it may make and name unfinished things, and have the last word on standard error. A signal
/// takes it for good.
std::unique_lock<std::recursive_mutex> hold_outputs();

}  // namespace understory
