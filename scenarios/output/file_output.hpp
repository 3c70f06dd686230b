#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "scenarios/output/errors.hpp"

/// The one way files are written.
namespace understory {

/// Writes a file: whole or not at all where it is a regular file or a new one (it bears another name that
/// ends with ".part" until then), straight through where it is a device, a FIFO or a descriptor as
/// /dev/stdout is. Symbolic links are followed. Throws MachineError where the disk is full or the reader is
/// gone, ScenarioError where the file cannot be written.
void write_whole_file(const std::filesystem::path& file, std::string_view content);

/// The same, and back only when it would outlive a power cut.
void write_lasting_file(const std::filesystem::path& file, std::string_view content);

/// Throws what write_whole_file would throw, as far as that can be known beforehand; for outputs that end the
/// work, before it starts. An empty name means no output.
void require_writable(const std::filesystem::path& file);

/// Makes `folder` and proves that files can be written into it. Throws as write_whole_file does.
void prepare_output_folder(const std::filesystem::path& folder);

/// Throws MachineError where fewer than `bytes` are free beside `file`: for writers that cannot tell (video).
void require_free_space(const std::filesystem::path& file, std::uintmax_t bytes);

/// Throws what errno says about an output.
[[noreturn]] void refuse_output(const std::filesystem::path& file, int error);

}  // namespace understory
