#include "tests/validation/mismatch_conditions.hpp"

#include <fmt/format.h>

namespace understory {

std::string MismatchCondition::name() const {
  return what.empty() ? "none" : fmt::format("{} {:+g} %", what, percent);
}

MismatchConfig adverse(double percent) {
  MismatchConfig mismatch;
  mismatch.mass_percent = percent;
  mismatch.lift_percent = -percent;
  mismatch.drag_percent = percent;
  mismatch.damping_percent = -percent;
  mismatch.delay_percent = 5 * percent;  // a delay is known least well: another 10 ms is soon overlooked
  return mismatch;
}

std::vector<MismatchCondition> mismatch_conditions() {
  std::vector<MismatchCondition> conditions(1);
  const auto add = [&](const char* what, double MismatchConfig::*property,
                       std::initializer_list<double> all) {
    for (const double percent : all) {
      MismatchCondition& condition = conditions.emplace_back();
      condition.what = what;
      condition.percent = percent;
      condition.mismatch.*property = percent;
    }
  };
  // A fifth is more than a scale or a wind tunnel leaves. Not flown, for time: more damping and a shorter
  // delay, which only add stability; a lift 10 % less, to the wing what a mass 10 % more is.
  add("mass", &MismatchConfig::mass_percent, {-20, 10, 20});
  add("lift", &MismatchConfig::lift_percent, {-20, 20});
  add("drag", &MismatchConfig::drag_percent, {-20, 20});
  add("damping", &MismatchConfig::damping_percent, {-20});
  add("delay", &MismatchConfig::delay_percent, {100});
  for (const double percent : {10.0, 15.0}) conditions.push_back({adverse_name, percent, adverse(percent)});
  return conditions;
}

}  // namespace understory
