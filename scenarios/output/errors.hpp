#pragma once

#include <csignal>
#include <stdexcept>
#include <string>

#include "perception/io/text_file.hpp"

/// Errors that end a command early. Each is one line on standard error.
namespace understory {

/// Bad input from a person: where (file:line, an option), the key, what was expected. Exit status 2.
using ScenarioError = InputError;

// MachineError (perception/io/text_file.hpp): the machine failed. Exit status 3.

/// A signal came. Exit status 128 and its number.
struct Stopped : std::runtime_error {
  int signal;
  explicit Stopped(int number = SIGINT, const std::string& what = "stopped")
      : std::runtime_error(what), signal(number) {}
};

}  // namespace understory
