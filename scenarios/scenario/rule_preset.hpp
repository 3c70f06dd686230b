#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "perception/pushbroom/pushbroom_stereo.hpp"

namespace understory {

enum class RulePreset { robust, tuned, paper };  ///< which numbers a pushbroom detector starts from

inline constexpr std::array<std::pair<std::string_view, RulePreset>, 3> rule_names{
    {{"robust", RulePreset::robust}, {"tuned", RulePreset::tuned}, {"paper", RulePreset::paper}}};

/// The numbers that a preset stands for with a rig of this name.
inline PushbroomConfig rule_of(RulePreset preset, std::string_view rig) {
  switch (preset) {
    case RulePreset::tuned:
      return tuned_rule(rig);
    case RulePreset::robust:
      return robust_rule();
    case RulePreset::paper:
      break;
  }
  return paper_rule();
}

}  // namespace understory
