#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace understory {

struct SourceFunction {
  std::string name;
  int lines = 0;  ///< from its first word to its closing brace
};

/// What a file of C++ says of itself. Reads braces, not the language: macros and both sides of an #if are
/// taken as they stand.
struct SourceFile {
  std::string path;                   ///< relative to the root, with slashes
  std::vector<std::string> includes;  ///< as written, in order
  std::vector<std::string> types;     ///< qualified names of the types defined outside anonymous namespaces
  std::vector<SourceFunction> functions;
  int lines = 0;

  std::string folder() const { return path.substr(0, path.rfind('/')); }
  bool is_source() const { return path.ends_with(".cpp"); }
};

/// @throws std::runtime_error where the file cannot be read or its braces do not match
SourceFile read_source_file(const std::filesystem::path& root, const std::filesystem::path& file);

/// Every .hpp, .cpp and .h under a folder of the root, sorted by path; none where there is no such folder.
std::vector<SourceFile> read_source_files(const std::filesystem::path& root, const std::string& folder);

}  // namespace understory
