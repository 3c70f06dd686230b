#pragma once

#include <sys/types.h>

#include <filesystem>
#include <mutex>

/// What becomes of unfinished work when SIGINT, SIGTERM or SIGHUP comes.
namespace understory {

/// From now on a signal ends the program at once, wherever it is: one line, every Unfinished removed, exit
/// status 128 and the signal's number. A thread does that, so that nothing has to ask. SIGHUP says nothing,
/// there is nobody to read it, and stays ignored where it was (nohup).
void end_on_signals();

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

/// Removes a file, or a folder with all that is in it. Its mark goes last: until then that says whose the
/// rest is, where it could not be removed.
void remove_unfinished(const std::filesystem::path& path);

/// Makes a folder and those above it. Throws as OutputFile, calling the folder by `name`.
void make_folders(const std::filesystem::path& folder, const std::filesystem::path& name);
/// Removes the folders that make_folders() made, as far as they are empty: when the work ends early.
void remove_made_folders();

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
  void rename_to(const std::filesystem::path& name);
  /// Leaves it where it is.
  void keep();

 private:
  std::filesystem::path path_;
  bool is_kept_ = false;
};

/// Whoever holds it may make and name unfinished things, and have the last word on standard error. A signal
/// takes it for good.
std::unique_lock<std::recursive_mutex> hold_outputs();

}  // namespace understory
