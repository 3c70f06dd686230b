#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

namespace understory {

/// How the replans of a flight were answered. straight + solved + kept + fallback is their number.
struct PlannerCounts {
  std::int64_t replans = 0;
  std::int64_t straight = 0;   ///< nothing within comfortable clearance of the straight way
  std::int64_t solved = 0;     ///< OMPL's answer of this replan taken
  std::int64_t kept = 0;       ///< the plan in force still good
  std::int64_t kept_ompl = 0;  ///< of `kept`: the rest of an OMPL answer; the others go straight
  std::int64_t fallback = 0;   ///< no free manoeuvre found: the primitive with the maximum clearance
  std::int64_t obstacle_ahead = 0;       ///< straight on would come nearer than the minimum clearance
  std::int64_t obstacle_ahead_ompl = 0;  ///< of those: flown on an OMPL answer, of this replan or kept
  std::int64_t searches = 0;  ///< how often OMPL was asked (a kept plan is searched against anew now and then)
  std::int64_t found = 0;     ///< how often it answered with a free manoeuvre
};

/// Every count by name, for results, rows and sums: visit(name, count).
template <typename Visitor, typename Counts>
requires std::same_as<std::remove_const_t<Counts>, PlannerCounts>
void visit_fields(Visitor& visit, Counts& counts) {
  visit("replans", counts.replans);
  visit("straight", counts.straight);
  visit("solved", counts.solved);
  visit("kept", counts.kept);
  visit("kept_ompl", counts.kept_ompl);
  visit("fallback", counts.fallback);
  visit("obstacle_ahead", counts.obstacle_ahead);
  visit("obstacle_ahead_ompl", counts.obstacle_ahead_ompl);
  visit("searches", counts.searches);
  visit("found", counts.found);
}

}  // namespace understory
