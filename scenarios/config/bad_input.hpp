#pragma once

#include <stdexcept>

#include "scenarios/config/quiet_standard_error.hpp"
#include "scenarios/output/errors.hpp"

namespace understory {

/// Gives back what `read` gives. What perception's readers refuse is bad input to this program, and theirs is
/// the one line about it: whatever the libraries beneath them print is left out.
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
