#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/output/errors.hpp"

/// The functions through which all files are written.
namespace understory {

class FolderMark;

/// A file being written. A regular file, or a new one, appears whole or not at all: it has another name until
/// finish(), which returns only when the file would outlive a power cut (in an UnfinishedFolder the folder
/// sees to that). A device, a FIFO or a descriptor as /dev/stdout is written straight through. Symbolic links
/// are followed. All throw MachineError where the disk is full or the reader is gone, ScenarioError where the
/// file cannot be written.
class OutputFile {
 public:
  /// `mark`: of the results that the file is added to; it lists the file once that is whole. Throws
  /// ScenarioError if a file is there that the mark does not list.
  explicit OutputFile(std::filesystem::path file, FolderMark* mark = nullptr);
  ~OutputFile();
  void write(std::string_view bytes);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a whole file in one call.
void write_whole_file(const std::filesystem::path& file, std::string_view content,
                      FolderMark* mark = nullptr);

/// Throws what writing would throw, as far as that can be known beforehand. To be called before work that
/// writes this output at its end. Removes unfinished files of killed programs beside it. An empty name: no
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

/// `path` relative to `folder`; empty if it is not below it.
std::filesystem::path path_within(const std::filesystem::path& path, const std::filesystem::path& folder);
[[noreturn]] void refuse_other_use(const std::filesystem::path& output, const char* use);

/// The file that marks a folder as one of results (FolderMark).
inline constexpr const char* mark_name = ".understory";

/// Returns the first file below `folder`, by relative path, for which is_wanted is true. Leaves out the mark,
/// unfinished files, and folders below that have a mark of their own. Throws as writing does if a file or
/// folder cannot be read.
std::optional<std::string> find_below(const std::filesystem::path& folder,
                                      const std::function<bool(const std::string&)>& is_wanted);
/// All files that find_below() looks at, sorted.
std::vector<std::string> files_below(const std::filesystem::path& folder);

/// Whether the name leads to a device, a FIFO or a descriptor of this process, which are neither replaced nor
/// removed. Throws as writing does.
bool is_stream(const std::filesystem::path& file);

/// Whether a file or folder has the name of an unfinished one.
bool is_unfinished_name(const std::filesystem::path& path);
/// Whether the name is one that unfinished_name_in() gives to files.
bool is_unfinished_file_name(const std::filesystem::path& path);
/// An unfinished name in `folder`: of this process alone; for `target`, the same in every process.
std::filesystem::path unfinished_name_in(const std::filesystem::path& folder);
std::filesystem::path unfinished_name_of(const std::filesystem::path& target,
                                         const std::filesystem::path& folder);

/// Waits until what was written into the folders is on the disk. Throws as writing does.
void sync_file_system(const std::filesystem::path& folder);
void sync_folder(const std::filesystem::path& folder);

/// Throws the error that `error`, an errno, means for an output.
[[noreturn]] void refuse_output(const std::filesystem::path& file, int error);

/// What zstd packed; nothing where it is damaged or would be larger.
std::optional<std::string> unpacked(std::string_view packed, std::size_t maximum_bytes);

}  // namespace understory
