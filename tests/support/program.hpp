#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "tests/support/text.hpp"

namespace understory::support {

/// The program's output (both streams) and exit status.
struct Outcome {
  int status = -1;
  std::string text;
};

/// Runs the program as a person does. `before`: environment variables or a change of folder.
inline Outcome understory(const std::string& arguments, const std::string& before = "") {
  FILE* pipe =
      popen((before + " " + std::string(UNDERSTORY_BINARY) + " " + arguments + " 2>&1").c_str(), "r");
  Outcome outcome;
  std::array<char, 4096> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) outcome.text += buffer.data();
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// Ends with status 0.
inline Outcome expect_success(const std::string& arguments, const std::string& before = "") {
  const Outcome outcome = understory(arguments, before);
  EXPECT_EQ(outcome.status, 0) << arguments << "\n" << outcome.text;
  return outcome;
}

/// One line that holds `part`, and that exit status.
inline void expect_refusal(const std::string& arguments, const std::string& part, int status = 2,
                           const std::string& before = "") {
  const Outcome outcome = understory(arguments, before);
  EXPECT_EQ(outcome.status, status) << arguments;
  expect_part(outcome.text, part);
  EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
}

}  // namespace understory::support
