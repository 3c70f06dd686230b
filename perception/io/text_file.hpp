#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace understory {

/// The whole content of a small text file. Throws as throw_file_fault does where `file` is a folder, cannot
/// be read, or holds more than 1 MiB: a calibration takes a few kilobytes, and a parser should not be fed a
/// picture or a device without end.
std::string read_text_file(const std::filesystem::path& file);

/// Throws std::runtime_error "file[:line]: key: expected", always one line of at most a few hundred
/// characters, whatever bytes the file had for a key or a value. `line` counts from 1; 0: none to name.
[[noreturn]] void throw_file_fault(const std::string& file, int line, const std::string& key,
                                   const std::string& expected);

/// `text` as a finite number, all of it; empty where it is none.
std::optional<double> finite_number(const std::string& text);

}  // namespace understory
