#include "scenarios/output/program.hpp"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <span>

#include "scenarios/flight/run_digest.hpp"

namespace understory {

const char* const understory_version = UNDERSTORY_VERSION;

std::string program_digest() {
  RunDigest digest;
  std::ifstream stream("/proc/self/exe", std::ios::binary);
  const std::string binary{std::istreambuf_iterator<char>(stream), {}};
  digest.add(std::as_bytes(std::span(binary)));
  return digest.hex();
}

void become_this_program(const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>("understory")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv("/proc/self/exe", argv.data());
  _exit(127);
}

}  // namespace understory
