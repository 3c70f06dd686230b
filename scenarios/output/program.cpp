#include "scenarios/output/program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <string_view>

namespace understory {

const char* const understory_version = UNDERSTORY_VERSION;

std::string program_digest() {
  std::ifstream stream("/proc/self/exe", std::ios::binary);
  const std::string binary{std::istreambuf_iterator<char>(stream), {}};
  return fmt::format("{:016x}", std::hash<std::string_view>{}(binary));
}

void become_this_program(const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>("understory")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv("/proc/self/exe", argv.data());
  _exit(127);
}

}  // namespace understory
