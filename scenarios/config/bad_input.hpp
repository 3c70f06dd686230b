#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "scenarios/output/errors.hpp"

namespace understory {

/// While it lives, nothing reaches stderr: libpng, libjpeg and FFmpeg complain there on their own, beside the
/// one line that says what is wrong with a file. Costs four system calls.
class QuietStandardError {
 public:
  QuietStandardError() : kept_(dup(STDERR_FILENO)) {
    std::fflush(stderr);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    if (kept_ >= 0) dup2(nowhere, STDERR_FILENO);
    close(nowhere);
  }
  ~QuietStandardError() {
    if (kept_ < 0) return;
    std::fflush(stderr);
    dup2(kept_, STDERR_FILENO);
    close(kept_);
  }
  QuietStandardError(const QuietStandardError&) = delete;
  QuietStandardError& operator=(const QuietStandardError&) = delete;

 private:
  int kept_;
};

/// Returns the result of `read`. Input that perception's readers refuse is bad input to this program. Their
/// error is the only line about it: output of the libraries beneath them is suppressed.
template <typename Read>
auto bad_input_if_refused(Read&& read) {
  try {
    const QuietStandardError quiet;
    return read();
  } catch (const MachineError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw ScenarioError(error.what());
  }
}

}  // namespace understory
