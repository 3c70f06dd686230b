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
struct ProgramRun {
  int status = -1;
  std::string text;
};

/// Runs the program as a person does. `before`: environment variables or a change of folder. `streams`: which
/// of them the text is of.
inline ProgramRun understory(const std::string& arguments, const std::string& before = "",
                             const char* streams = "2>&1") {
  FILE* pipe = popen((before + " " + UNDERSTORY_BINARY + " " + arguments + " " + streams).c_str(), "r");
  ProgramRun outcome;
  std::array<char, 4096> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) outcome.text += buffer.data();
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// Ends with status 0.
inline ProgramRun expect_success(const std::string& arguments, const std::string& before = "") {
  const ProgramRun outcome = understory(arguments, before);
  EXPECT_EQ(outcome.status, 0) << arguments << "\n" << outcome.text;
  return outcome;
}

/// Runs it in `folder`, and sends `signal` when `event`, a condition of the shell, has come ($p is the
/// process). The text is of its standard error.
inline ProgramRun stopped(const std::string& arguments, const std::string& folder, const std::string& signal,
                          const std::string& event) {
  return understory(arguments + " 2>&1 >/dev/null & p=$!; until " + event +
                        " >/dev/null 2>&1 || ! kill -0 $p 2>/dev/null; do sleep 0.02; done; kill -" + signal +
                        " $p; wait $p",
                    "cd " + folder + ";", "");
}

/// One line on standard error that holds `part`, and that exit status. Progress is said on the other stream.
inline void expect_refusal(const std::string& arguments, const std::string& part, int status = 2,
                           const std::string& before = "") {
  const ProgramRun outcome = understory(arguments, before, "2>&1 >/dev/null");
  EXPECT_EQ(outcome.status, status) << arguments;
  expect_part(outcome.text, part);
  EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
}

}  // namespace understory::support
