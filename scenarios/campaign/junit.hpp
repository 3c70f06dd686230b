#pragma once

#include <string>
#include <vector>

#include "scenarios/campaign/comparison.hpp"
#include "scenarios/campaign/gate.hpp"

namespace understory {

/// Flights as JUnit XML, which every CI server shows: a test suite per condition, in order of appearance, a
/// test case per flight; classname: the condition, name: the seed, time: simulated seconds. Each suite has
/// the program's version as a property. What XML 1.0 cannot hold (control characters, broken UTF-8) is
/// written as '?'.

/// A flight that did not reach its goal is a <failure>, one that failed to run an <error>.
std::string campaign_junit(const std::vector<FlightRow>& rows);

/// What the gate saw: a flight that reached its goal in the baseline and does not any more is a <failure>;
/// one that failed to run or is missing in the candidate an <error>; flights only the candidate has pass. A
/// suite "gate" has a test case per condition, which fails where it lost more than the rule allows. A server
/// that calls a build broken for any <failure> is stricter than the gate, whose exit status is its verdict.
std::string gate_junit(const Comparison& comparison, const GateRule& rule = {});

}  // namespace understory
