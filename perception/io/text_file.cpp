#include "perception/io/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "perception/io/machine_limits.hpp"

namespace understory {
namespace {

/// What a file said may be anything: a message stays one line of moderate length.
std::string quotable(std::string text, std::size_t maximum) {
  for (char& character : text)
    if (static_cast<unsigned char>(character) < ' ' || character == '\x7f') character = ' ';
  if (text.size() > maximum) text = text.substr(0, maximum) + "...";
  return text;
}

struct Closer {
  void operator()(std::FILE* stream) const { std::fclose(stream); }
};

/// Opens a pipe without waiting for somebody to write: where nobody does, it is at its end at once.
std::unique_ptr<std::FILE, Closer> opened(const std::string& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) return nullptr;
  fcntl(descriptor, F_SETFL, 0);  // whoever has the pipe open for writing is waited for
  return std::unique_ptr<std::FILE, Closer>(fdopen(descriptor, "rb"));
}

}  // namespace

void refuse_input(const std::string& place, const std::string& key, const std::string& expected) {
  constexpr std::size_t maximum_place = 4096, maximum_key = 80, maximum_expected = 400;
  throw InputError(quotable(place, maximum_place) + ": " + quotable(key, maximum_key) +
                   (key.empty() ? "" : ": ") + quotable(expected, maximum_expected));
}

std::string place_in(const std::string& file, int line) { return file + ":" + std::to_string(line); }

std::string read_file(const std::filesystem::path& file, std::size_t maximum_bytes) {
  const std::string name = file.string();
  const auto refuse = [&](const char* found) {
    refuse_input(name, "", std::string("cannot read this file") + found);
  };
  const std::string too_large = "must be at most " + std::to_string(maximum_bytes >> 20) + " MiB";
  const auto refuse_for_errno = [&] {
    const std::string lacking = lacking_resource(errno);
    if (!lacking.empty()) throw MachineError(name + ": " + lacking);
    refuse((std::string(": ") + std::strerror(errno)).c_str());
  };
  struct stat is {};
  if (stat(name.c_str(), &is) != 0) refuse_for_errno();
  if (S_ISDIR(is.st_mode)) refuse(", this is a folder");
  if (!S_ISREG(is.st_mode) && !S_ISFIFO(is.st_mode)) refuse(", this is a device");
  if (S_ISREG(is.st_mode) && static_cast<std::size_t>(is.st_size) > maximum_bytes)
    refuse_input(name, "", too_large);
  const auto stream = opened(name);
  if (!stream) refuse_for_errno();
  std::string text;
  text.reserve(static_cast<std::size_t>(is.st_size));
  std::array<char, 65536> piece;
  while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), stream.get())) {
    text.append(piece.data(), count);
    if (text.size() > maximum_bytes) refuse_input(name, "", too_large);
  }
  if (std::ferror(stream.get()) != 0) refuse_for_errno();
  return text;
}

}  // namespace understory
