#include "scenarios/output/file_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  if (error == ENOSPC || error == EDQUOT || error == EIO) {
    throw MachineError(fmt::format("{}: {}", file.string(), std::strerror(error)));
  }
  throw ScenarioError(fmt::format("{}: expected a writable output: {}", file.string(), std::strerror(error)));
}

void write_through(const std::filesystem::path& file, const std::string& part, std::string_view content,
                   bool lasting) {
  std::FILE* stream = std::fopen(part.c_str(), "wb");
  if (stream == nullptr) fail(file, errno);
  int error = 0;
  if (std::fwrite(content.data(), 1, content.size(), stream) != content.size()) error = errno;
  if (error == 0 && lasting && (std::fflush(stream) != 0 || fsync(fileno(stream)) != 0)) error = errno;
  if (std::fclose(stream) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(part.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) return;
  std::remove(part.c_str());
  fail(file, error);
}

}  // namespace

void prepare_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(folder, error.value());
  if (!std::filesystem::is_directory(folder)) fail(folder, ENOTDIR);
  const std::filesystem::path probe = folder / ".probe";
  std::FILE* stream = std::fopen(probe.c_str(), "wb");
  if (stream == nullptr) fail(folder, errno);
  std::fclose(stream);
  std::filesystem::remove(probe, error);
}

void write_whole_file(const std::filesystem::path& file, std::string_view content) {
  write_through(file, file.string() + ".part", content, false);
}

void write_lasting_file(const std::filesystem::path& file, std::string_view content) {
  char host[64] = "";
  gethostname(host, sizeof host - 1);
  write_through(file, fmt::format("{}.{}-{}.part", file.string(), host, getpid()), content, true);
  // The new name is the folder's, and lasts once that has reached the disk.
  const int folder = open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY);
  if (folder >= 0) {
    fsync(folder);
    close(folder);
  }
}

void require_free_space(const std::filesystem::path& file, std::uintmax_t bytes) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(file.parent_path(), error);
  if (!error && space.available < bytes) fail(file, ENOSPC);
}

}  // namespace understory
