#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/output/errors.hpp"

/// The one way files are written.
namespace understory {

class FolderMark;

/// A file being written. A regular file, or a new one, appears whole or not at all: it bears another name
/// until finish(), which returns only when the file would outlive a power cut (in an UnfinishedFolder the
/// folder sees to that). A device, a FIFO or a descriptor as /dev/stdout is written straight through.
/// Symbolic links are followed. All throw MachineError where the disk is full or the reader is gone,
/// ScenarioError where the file cannot be written.
class OutputFile {
 public:
  /// `mark`: of the results that it is added to; lists it when it is whole. Throws ScenarioError where a
  /// file is there that the mark does not list.
  explicit OutputFile(std::filesystem::path file, FolderMark* mark = nullptr);
  ~OutputFile();
  void write(std::string_view bytes);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The same at once.
void write_whole_file(const std::filesystem::path& file, std::string_view content,
                      FolderMark* mark = nullptr);

/// Throws what writing would throw, as far as that can be known beforehand; for outputs that end the work,
/// before it starts. Clears away what killed programs left unfinished beside it. An empty name means no
/// output.
void require_writable(const std::filesystem::path& file);

/// Makes `folder` and proves that files can be written into it. Throws as writing does.
void prepare_output_folder(const std::filesystem::path& folder);

/// Throws ScenarioError where one of `outputs` is also one of `others` or is given twice. Empty names mean
/// nothing; devices and FIFOs may be given again and again.
void require_separate(const std::vector<std::filesystem::path>& outputs,
                      const std::vector<std::filesystem::path>& others);

/// Throws ScenarioError where `folder` is one of `others` or lies within one.
void require_not_within(const std::filesystem::path& folder,
                        const std::vector<std::filesystem::path>& others);

/// `path` below `folder`; empty where it is not.
std::filesystem::path path_within(const std::filesystem::path& path, const std::filesystem::path& folder);
[[noreturn]] void refuse_other_use(const std::filesystem::path& output, const char* use);

/// The file that marks a folder as one of results (FolderMark).
inline constexpr const char* mark_name = ".understory";

/// Looks at each file below `folder`, by relative path, but for the mark and what is unfinished; gives the
/// first that is wanted. Leaves out folders below that have a mark of their own. Throws as writing where one
/// cannot be looked at.
std::optional<std::string> find_below(const std::filesystem::path& folder,
                                      const std::function<bool(const std::string&)>& is_wanted);
/// All of them, sorted.
std::vector<std::string> files_below(const std::filesystem::path& folder);

/// Whether the name leads to a device, a FIFO or a descriptor of this process: what is there stays. Throws as
/// writing.
bool is_stream(const std::filesystem::path& file);

/// Whether a file or folder bears the name of something that a program is at work on.
bool is_unfinished_name(const std::filesystem::path& path);
/// Whether it is one that unfinished_name_in() gives to files.
bool is_unfinished_file_name(const std::filesystem::path& path);
/// Such a name in `folder`: for this process alone; for what will be called `target`, whoever makes it.
std::filesystem::path unfinished_name_in(const std::filesystem::path& folder);
std::filesystem::path unfinished_name_of(const std::filesystem::path& target,
                                         const std::filesystem::path& folder);

/// What was written into the folders reaches the disk. Throws as writing does.
void sync_file_system(const std::filesystem::path& folder);
void sync_folder(const std::filesystem::path& folder);

/// Throws what errno says about an output.
[[noreturn]] void refuse_output(const std::filesystem::path& file, int error);

}  // namespace understory
