#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace understory {

/// The machine failed us: a full disk, a missing GL library. One line; exit status 3.
struct MachineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Makes `folder` and proves that files can be written into it. Throws ScenarioError where not.
void prepare_output_folder(const std::filesystem::path& folder);

/// Writes to "<file>.part" and renames it when all of it is on its way, so that no half-written file looks
/// whole; a failed .part is removed. Throws MachineError where the disk is full, ScenarioError where it
/// cannot be written.
void write_whole_file(const std::filesystem::path& file, std::string_view content);

/// The same, and back only when it would outlive a power cut. Two programs may write one file at a time, even
/// from two machines: each has a .part of its own.
void write_lasting_file(const std::filesystem::path& file, std::string_view content);

/// Throws MachineError where fewer than `bytes` are free beside `file`: for writers that cannot tell (video).
void require_free_space(const std::filesystem::path& file, std::uintmax_t bytes);

}  // namespace understory
