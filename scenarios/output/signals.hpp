#pragma once

#include <sys/types.h>

#include <filesystem>
#include <mutex>

/// What becomes of unfinished work when SIGINT, SIGTERM or SIGHUP comes.
namespace understory {

/// From now on a signal ends the program at once, wherever it is: one line, every Unfinished removed, exit
/// status 128 and the signal's number. A thread does that, so that no code has to poll. SIGHUP prints no
/// line, because nobody can read it, and stays ignored if it was (nohup).
void end_on_signals();

/// A child process that ends with this one: after a signal here it gets SIGHUP, and its end is waited for.
void ends_with_us(pid_t child);
void has_ended(pid_t child);

/// While it lives, the signals do not end the program; they are remembered, for work that ends by itself. If
/// several live, the outermost counts.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  bool asked() const { return number() != 0; }
  int number() const;  ///< the signal that came; 0: none
};

/// Removes a file, or a folder with all that is in it. Its mark is removed last: if something else cannot be
/// removed, the mark still shows whose it is.
void remove_unfinished(const std::filesystem::path& path);

/// Makes a folder and those above it. Throws as OutputFile, calling the folder by `name`.
void make_folders(const std::filesystem::path& folder, const std::filesystem::path& name);
/// Removes the folders that make_folders() made, as far as they are empty: when the work ends early.
void remove_made_folders();

/// A file or folder that has another name until it is whole, and is removed if the work ends before: by an
/// exception or by a signal.
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

/// The lock for making and renaming unfinished files and for the last line on standard error. A signal takes
/// it for good.
std::unique_lock<std::recursive_mutex> hold_outputs();

}  // namespace understory
