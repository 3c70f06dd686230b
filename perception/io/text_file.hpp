#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace understory {

/// The user's input cannot be used. One line "file:line: key: what was expected", or "--set a.b=3: ...".
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The machine failed: a full disk, a missing library, no more memory.
struct MachineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws InputError "place: key: expected", always one line of at most a few hundred characters, for any
/// bytes of a key or a value. An empty `key` is left out.
[[noreturn]] void refuse_input(const std::string& place, const std::string& key, const std::string& expected);

/// "file:line"; lines count from 1.
std::string place_in(const std::string& file, int line);

/// The largest file that a reader accepts. A parser should not get a picture or an endless device.
constexpr std::size_t maximum_keyed_bytes = std::size_t{1} << 20;  ///< scenarios, calibrations
constexpr std::size_t maximum_json_bytes = std::size_t{16} << 20;
constexpr std::size_t maximum_table_bytes = std::size_t{256} << 20;  ///< poses, lists of images, rows
constexpr std::size_t maximum_image_bytes = std::size_t{256} << 20;

/// The whole content of a regular file, or of a pipe that somebody writes. Throws InputError where `file` is
/// none of these, cannot be read, or holds more than `maximum_bytes` (of a regular file: before reading),
/// MachineError where the machine lacks memory or descriptors.
std::string read_file(const std::filesystem::path& file, std::size_t maximum_bytes = maximum_keyed_bytes);

}  // namespace understory
