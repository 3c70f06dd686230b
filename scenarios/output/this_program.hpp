#pragma once

#include <unistd.h>

#include <string>
#include <vector>

namespace understory {

/// Makes the calling process, fresh from fork(), this very program anew, with `arguments` (without its name);
/// exits with 127 where that fails.
[[noreturn]] inline void become_this_program(const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>("understory")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv("/proc/self/exe", argv.data());
  _exit(127);
}

}  // namespace understory
