#pragma once

#include <hwy/targets.h>

#include <cstdint>
#include <string>

namespace understory::support {

/// Runs `work(name)` once on each of Highway's targets that this machine has, then leaves the choice to
/// Highway again.
template <typename Work>
void on_every_instruction_set(Work&& work) {
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    work(std::string(hwy::TargetName(target)));
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

}  // namespace understory::support
