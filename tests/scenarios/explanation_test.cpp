#include "scenarios/explain/explanation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "scenarios/config/named_seed.hpp"
#include "scenarios/explain/evidence.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {
namespace {

using Parts = std::vector<std::string>;
/// The true chance to survive.
using Law = std::function<double(const Parts& parts, double before_end_s)>;

bool has(const Parts& parts, std::string_view part) { return std::ranges::find(parts, part) != parts.end(); }

/// Draws by the law. The same noise has the same luck, whatever the parts; or, as after a chaotic second,
/// another for each part.
Explanation explained(const Law& law, std::uint64_t luck = 1, const Parts& shown = {},
                      bool is_shared = true) {
  const FlyRedraws fly = [&](std::vector<Redraw>& asked) {
    for (Redraw& one : asked) {
      const std::string parts = is_shared ? "" : fmt::format("{}", fmt::join(one.parts, " "));
      const std::uint64_t mixed = seed_for(luck * 1000 + one.seed, std::to_string(one.before_end_s) + parts);
      one.survived = static_cast<double>(mixed >> 11) * 0x1p-53 < law(one.parts, one.before_end_s);
    }
  };
  return explain({moments_of(8), 170, 1, [&](double) { return shown; }}, fly);
}

/// The control survives from 1.5 s before the end in six of ten.
double chaotic(double before_end_s) { return before_end_s < 1 ? 0 : before_end_s < 1.5 ? 0.1 : 0.6; }

TEST(Explanation, TheMonotoneFitPoolsWhatFalls) {
  const std::vector<Share> shares{{4, 0}, {4, 2}, {4, 1}, {0, 0}, {4, 4}};
  const std::vector<double> fitted = monotone_fit(shares);
  ASSERT_EQ(fitted.size(), 5);
  EXPECT_DOUBLE_EQ(fitted[0], 0);
  EXPECT_DOUBLE_EQ(fitted[1], 3.0 / 8);  // two of four and one of four
  EXPECT_DOUBLE_EQ(fitted[2], 3.0 / 8);
  EXPECT_DOUBLE_EQ(fitted[3], 3.0 / 8);
  EXPECT_DOUBLE_EQ(fitted[4], 1);
  EXPECT_TRUE(std::ranges::is_sorted(fitted));
  EXPECT_EQ(monotone_fit(std::vector<Share>{{0, 0}, {0, 0}}), (std::vector<double>{0, 0}));
}

TEST(Explanation, ThePartThatSavesIsTheCauseWhateverTheLuck) {
  for (const std::string_view guilty : ideal_part_names) {
    int right = 0;
    for (std::uint64_t luck = 1; luck <= 20; ++luck) {
      const Explanation why = explained(
          [&](const Parts& parts, double before_end_s) {
            return has(parts, guilty) && before_end_s >= 0.75 ? 0.9 : chaotic(before_end_s);
          },
          luck);
      right += why.cause == guilty;
      EXPECT_LE(why.flights.size(), 170);
    }
    EXPECT_GE(right, 19) << guilty;
  }
}

TEST(Explanation, WhereNothingHelpsAndARedrawArrivesItWasChance) {
  std::map<std::string, int> found;
  for (std::uint64_t luck = 1; luck <= 60; ++luck)
    ++found[explained([](const Parts&, double before_end_s) { return chaotic(before_end_s); }, luck, {},
                      false)
                .cause];
  EXPECT_GE(found["chance"], 50) << "of seven parts that do nothing one seems to help in one case of six";
  EXPECT_EQ(found["infeasible"], 0) << "the control itself arrives in six of ten";
}

TEST(Explanation, WhereNotEvenEverythingHelpsItWasInfeasible) {
  const Explanation why = explained([](const Parts&, double) { return 0.02; });
  EXPECT_EQ(why.cause, "infeasible");
  EXPECT_FALSE(why.last_chance_s.has_value());
}

TEST(Explanation, TwoPartsThatHelpOnlyTogetherAreJoint) {
  const Explanation why = explained([](const Parts& parts, double before_end_s) {
    return has(parts, "state") && has(parts, "search") && before_end_s >= 0.75 ? 0.95 : chaotic(before_end_s);
  });
  EXPECT_EQ(why.cause, "joint");
  EXPECT_EQ(why.parts, (Parts{"state", "search"}));
  EXPECT_TRUE(conclusion_of(why, {}).sentence.ends_with("though not without an ideal state or search."));
}

TEST(Explanation, SightIsTheCauseOnlyWhereNoOtherPartHelpsHalfAsMuch) {
  const auto law = [](double by_latency) {
    return [by_latency](const Parts& parts, double before_end_s) {
      if (before_end_s < 0.75) return 0.0;
      return has(parts, "sight") ? 0.95 : has(parts, "latency") ? by_latency : chaotic(before_end_s);
    };
  };
  EXPECT_EQ(explained(law(0.8)).cause, "latency");
  EXPECT_EQ(explained(law(0.3)).cause, "sight");
}

/// Between effects so close the luck of the redraws would decide, and a second opinion would be another.
TEST(Explanation, OfComparableEffectsTheOneWhoseFaultTheLogShowsIsTheCause) {
  const auto law = [](double by_detection) {
    return [by_detection](const Parts& parts, double before_end_s) {
      if (before_end_s < 0.75) return 0.0;
      return has(parts, "search") ? 0.8 : has(parts, "detection") ? by_detection : chaotic(before_end_s);
    };
  };
  int by_the_log = 0, by_the_effect = 0;
  for (std::uint64_t luck = 1; luck <= 20; ++luck) {
    by_the_log += explained(law(0.8), luck, {"detection", "map"}).cause == "detection";
    by_the_effect += explained(law(0.1), luck, {"detection", "map"}).cause == "search";
  }
  EXPECT_GE(by_the_log, 19);
  EXPECT_GE(by_the_effect, 19);
}

/// A planner that found a way each time did not want for a longer search.
TEST(Explanation, ASearchThatDidNotFailComesAfterASightThatDoesMore) {
  const auto law = [](const Parts& parts, double before_end_s) {
    if (before_end_s < 0.75) return 0.0;
    return has(parts, "sight") ? 0.95 : has(parts, "search") ? 0.8 : chaotic(before_end_s);
  };
  EXPECT_EQ(explained(law).cause, "sight");
  EXPECT_EQ(explained(law, 1, {"search"}).cause, "search");
  const auto with_latency = [&](const Parts& parts, double before_end_s) {
    return has(parts, "latency") && before_end_s >= 0.75 ? 0.75 : law(parts, before_end_s);
  };
  EXPECT_EQ(explained(with_latency).cause, "latency") << "though search has the greater effect";
}

TEST(Explanation, EqualAnswersGiveEqualQuestions) {
  const Law law = [](const Parts& parts, double before_end_s) {
    return has(parts, "map") ? 0.7 : chaotic(before_end_s);
  };
  EXPECT_EQ(explained(law).flights, explained(law).flights);
}

/// A sensor's fault is a cause only where the schedule has one: else the words would say what did not happen.
TEST(Evidence, OnlyAFaultOfASensorIsASensorsFault) {
  FlightLog log;
  log.moments.resize(2);
  log.moments[1].t_ns = 5'000'000'000;
  Explanation explanation;
  explanation.cause = "state";
  explanation.decisive_s = {1};
  explanation.effects.emplace_back().part = "state";
  EXPECT_EQ(conclusion_of(explanation, evidence_in(log, 1)).cause, "wrong place");
  log.scenario.faults = {{FaultySensor::pitot, FaultKind::bias, 3}};
  EXPECT_EQ(conclusion_of(explanation, evidence_in(log, 1)).cause, "sensor's fault");
  log.scenario.faults = {{FaultySensor::camera, FaultKind::cover, 3}};
  EXPECT_EQ(conclusion_of(explanation, evidence_in(log, 1)).cause, "wrong place");
}

TEST(Evidence, AnEmergencyAfterTheLastChanceIsNoFailedSearch) {
  FlightLog log;
  log.moments.resize(2);
  log.moments[1].t_ns = 5'000'000'000;
  log.plans.resize(1);
  log.plans[0].t_ns = 4'000'000'000;
  log.plans[0].origin = PlanOrigin::fallback;
  const auto is_shown = [&](double last_chance_s) {
    const std::vector<Evidence> all = evidence_in(log, last_chance_s);
    return std::ranges::find(all, "search", &Evidence::part)->is_there;
  };
  EXPECT_TRUE(is_shown(0.75));
  EXPECT_FALSE(is_shown(1.5));
}

/// The middle of what is seen of a thick trunk lies half a metre off its axis, wherever the map has it.
TEST(Evidence, PointsOnTheSkinOfAThickTrunkAreInTheirPlace) {
  FlightLog log;
  log.moments.resize(2);
  log.moments[1].t_ns = 5'000'000'000;
  Obstacle& trunk = log.obstacles.emplace_back();
  trunk.to_world.z() = 6;
  log.result.touched = trunk.name = "tree";
  log.result.outcome = Outcome::collision;
  LogPoint& point = log.points.emplace_back();
  point.to_ns = still_there_ns;
  const auto is_shown = [&](double radius_m, double off_m) {
    trunk.radius_m = radius_m;
    point.point.position_world = {-off_m, 0, 3};
    const std::vector<Evidence> all = evidence_in(log, 1);
    return std::ranges::find(all, "state", &Evidence::part)->is_there;
  };
  EXPECT_FALSE(is_shown(0.15, 0.2));
  EXPECT_TRUE(is_shown(0.15, 0.4));
  EXPECT_FALSE(is_shown(0.5, 0.5));
  EXPECT_TRUE(is_shown(0.5, 0.7));
}

TEST(Evidence, AnEffectWithoutATraceInTheLogSaysSo) {
  Explanation explanation;
  explanation.cause = "sight";
  explanation.decisive_s = {1};
  explanation.effects.emplace_back().part = "sight";
  EXPECT_TRUE(conclusion_of(explanation, {})
                  .disagreement.ends_with("it touched nothing, and sight leaves no other trace."));
}

/// A detection that becomes ideal when the thing has passed the depth that is looked at does not find it.
TEST(Evidence, WhatWasMissedAtItsDepthIsNotDetectedAlsoWhereOnlySightSaves) {
  Explanation explanation;
  explanation.cause = "sight";
  explanation.decisive_s = {1};
  explanation.effects.emplace_back().part = "sight";
  std::vector<Evidence> evidence{{"never in view", "sight", false, ""},
                                 {"seen too late", "sight", false, ""},
                                 {"not detected", "detection", true, ""}};
  EXPECT_EQ(conclusion_of(explanation, evidence).cause, "not detected");
  evidence[0].is_there = true;
  EXPECT_EQ(conclusion_of(explanation, evidence).cause, "never in view");
  evidence[0].is_there = evidence[2].is_there = false;
  evidence[1].is_there = true;
  EXPECT_EQ(conclusion_of(explanation, evidence).cause, "seen too late");
}

}  // namespace
}  // namespace understory
