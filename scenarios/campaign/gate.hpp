#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/statistics/sequential.hpp"

namespace understory {

/// A campaign that is to be compared, with the rows of its flights.csv.
struct ComparedCampaign {
  CampaignFolder folder;
  Campaign campaign;
  std::vector<FlightRow> rows;
};
/// Throws ScenarioError where the folder holds no campaign with results.
ComparedCampaign read_compared(const std::filesystem::path& folder);

/// Why flights of two campaigns cannot be equal to the bit, by the pictures that their renderers draw; empty:
/// they draw the same; nothing: an older campaign does not say.
std::optional<std::string> drawn_differently(const Campaign& baseline, const Campaign& candidate);

/// The same condition and seed in both campaigns.
struct FlightPair {
  FlightRow baseline;
  FlightRow candidate;

  bool flown() const { return baseline.flown() && candidate.flown(); }
  bool got_worse() const { return flown() && baseline.reached_goal() && !candidate.reached_goal(); }
  bool got_better() const { return flown() && !baseline.reached_goal() && candidate.reached_goal(); }
};

/// One figure over the pairs in which both flights were flown and have it.
struct MetricComparison {
  std::string name;  ///< of FlightRow's field, its unit at the end
  int pairs = 0;
  double baseline_mean = 0;
  double candidate_mean = 0;
  BootstrapEstimate difference;  ///< candidate less baseline
};

/// Pairs of one condition, or of all.
struct ConditionComparison {
  std::string condition;          ///< "all" for all of them
  std::vector<FlightPair> pairs;  ///< by seed
  PairedOutcomes goals;           ///< of pairs both flown; first: baseline, second: candidate
  double p = 1;                   ///< McNemar's, that both succeed alike
  Interval difference;            ///< 95 %, of the share of goals: candidate less baseline
  std::vector<MetricComparison> metrics;
  int bit_for_bit = 0;  ///< pairs with the same digest: nothing that affects a flight has changed
  SignCounts signs() const { return signs_of(goals); }
};

/// Two campaigns, paired by condition and seed. A flight that failed to run on either side counts in no
/// figure: a program that failed says nothing about how well it avoids trees. It is listed instead.
struct Comparison {
  std::vector<ConditionComparison> conditions;  ///< those with a pair, in the baseline's order
  ConditionComparison all;
  std::vector<FlightRow> missing;          ///< in the baseline only
  std::vector<FlightRow> added;            ///< in the candidate only
  std::vector<FlightRow> baseline_failed;  ///< failed to run, in either set, paired or not
  std::vector<FlightRow> candidate_failed;
  /// Conditions of one name with another goal, speed or density in the two sets, and these: "forest: goal at
  /// 75 m instead of 1015 m". Their difference is not due to the program alone.
  std::vector<std::string> altered;
  /// Why digests say nothing: "A in the baseline, B in the candidate", if the two sets were drawn by
  /// different renderers. Then bit_for_bit is 0 everywhere.
  std::string drawn_differently;
};

/// Throws ScenarioError where a set has a seed of a condition twice. `drawn_differently`: see Comparison; by
/// default the names of the renderers in the rows tell.
Comparison compare_campaigns(const std::vector<FlightRow>& baseline, const std::vector<FlightRow>& candidate,
                             const std::optional<std::string>& drawn_differently = {});

/// A figure that may get worse by so much, in its unit: `minimum_clearance_m` by 0.1.
struct Tolerance {
  std::string figure;
  double loss = 0;
};

struct GateRule {
  double margin = 0.05;  ///< a fall of the share of goals that matters, 0.001 .. 0.5
  double alpha = 0.05;   ///< how often the gate may err, either way, however often somebody looks
  std::vector<Tolerance> tolerances = {};  ///< none: figures other than success decide nothing
};

/// Throws ScenarioError if a tolerance is about a figure that no comparison has.
void require_known_figures(const GateRule& rule);

enum class Verdict {
  not_worse,  ///< a fall by the margin is refuted
  unchanged,  ///< every pair of flights is equal to the bit
  worse,      ///< that success did not fall is refuted; or flights failed to run or are missing
  undecided   ///< neither: more flights would tell
};
inline constexpr std::array<std::pair<std::string_view, Verdict>, 4> verdict_names{
    {{"not worse", Verdict::not_worse},
     {"unchanged on these flights", Verdict::unchanged},
     {"worse", Verdict::worse},
     {"not enough flights", Verdict::undecided}}};

/// Whether a change may pass, by the pairs that were flown on both sides.
///
/// - worse: a flight of the candidate failed to run, or one of the baseline is missing (else dropping the
///   hard seeds would pass).
/// - unchanged: all digests are equal, so nothing can have fallen on these seeds.
/// - worse: the evidence that success fell by more than the margin in a condition, as the mean over the
///   conditions, reaches 2 / alpha. So a forest that breaks is seen among many that do not.
/// - not worse: the evidence against "success fell by the margin or more", over all pairs, reaches 1 / alpha.
/// - worse: the evidence against "success did not fall, in no condition" reaches 1 / alpha. It is the mean of
///   that of all pairs and of the conditions' mean (means of e-values are e-values: Vovk & Wang 2021, Annals
///   of Statistics 49, 1736). The second rule can hold only where this one does, too, so it costs nothing.
/// - undecided: none of these is known yet.
///
/// Of changes that leave success as it is alpha at most are called worse, and of those that lower it by the
/// margin alpha at most not worse, at all looks together (sequential.hpp), if every look is at as many pairs
/// of each condition and the scenarios fly seeds of their own (seeds_apart): pairs on the same trees may
/// change together. A fall between nothing and the margin may get either verdict. Tolerances are judged by
/// the paired bootstrap interval, 95 % at one look: worse if a loss beyond the tolerance is shown, undecided
/// if it is not ruled out either.
struct GateVerdict {
  Verdict verdict = Verdict::undecided;
  std::vector<std::string> reasons;  ///< a line each
  double largest_fall = 1;           ///< of the share of goals, that these pairs do not exclude
  Interval difference;               ///< sequential, one-sided alpha at each end: candidate less baseline
  double smallest_shown = 1;  ///< smallest net loss, as a share of these pairs, that is called worse; 2: none
  double changed_at_most = 1;  ///< unchanged alone: share of other seeds that would differ in any condition
  int more_pairs = 0;          ///< undecided: pairs still to be flown if they come out like these; 0: unknown

  bool passes() const { return verdict == Verdict::not_worse || verdict == Verdict::unchanged; }
  std::string name() const;
};

GateVerdict verdict_on(const Comparison& comparison, const GateRule& rule = {});

/// What the verdict rests on: how many pairs gained, stayed and lost, all together and in each condition.
struct GateCounts {
  SignCounts all;
  std::vector<SignCounts> conditions;
};
/// The same by the counts alone: not_worse, worse or undecided.
Verdict verdict_on(const GateCounts& counts, const GateRule& rule);

/// Pairs after which a change that alters outcomes but not their rate is called not worse with probability
/// `power`, looked at after every ten: simulated, with the same random numbers each time. `discordance`:
/// share of pairs whose outcome differs. 0: 20,000 pairs are not enough.
int planned_pairs(double discordance, double power, const GateRule& rule);

/// What a comparison is about, for its reports.
struct GateSides {
  std::string baseline, candidate;  ///< folders, or conditions
  std::string page = {};            ///< file of the page with replays; empty: none
  /// The command that flies a flight of the candidate again; empty: unknown.
  std::function<std::string(const FlightRow& row)> command = {};
};

/// "3 (collision), 7, ... and 12 more": a log is read; the other outputs have all of them.
template <typename Item, typename Word>
std::string some_of(const std::vector<Item>& items, Word&& word) {
  constexpr std::size_t named_at_most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(items.size(), named_at_most); ++i)
    text += (i == 0 ? "" : ", ") + word(items[i]);
  return items.size() > named_at_most
             ? text + " and " + std::to_string(items.size() - named_at_most) + " more"
             : text;
}
/// "1 flight", "3 flights".
std::string flights_text(std::size_t count);
/// "forest-3 (hung), dense-7 and 12 more": the first twenty, with the reasons of those that failed to run.
std::string names_text(const std::vector<FlightRow>& rows);

/// For a person at a CI log: success per condition with intervals, p and difference; the other figures of
/// conditions in which any flight changed; the seeds that got worse and better; what could not be compared;
/// the verdict last.
std::string to_report(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule);

/// The same as a comment on a change: the verdict first.
std::string to_markdown(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule,
                        const GateSides& sides);

/// The same for a program: verdict, rule, counts and intervals, conditions, figures, seeds that changed.
std::string to_json(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule,
                    const GateSides& sides);

/// What the verdict says, in one sentence with its figures.
std::string sentence_of(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule);

/// Flights as JUnit XML, which every CI server shows: a test suite per condition, in order of appearance, a
/// test case per flight; classname: the condition, name: the seed, time: simulated seconds. Each suite has
/// the program's version as a property. What XML 1.0 cannot hold (control characters, broken UTF-8) is
/// written as '?'. A flight that did not reach its goal is a <failure>, one that failed to run an <error>.
std::string campaign_junit(const std::vector<FlightRow>& rows);

/// The gate's comparison: a flight that reached its goal in the baseline and does not any more is a
/// <failure> unless the verdict passes, and else a remark; one that failed to run or is missing in the
/// candidate an <error>; flights only the candidate has pass. A suite "gate" has one test case, which fails
/// unless the verdict passes.
std::string gate_junit(const Comparison& comparison, const GateVerdict& verdict);

}  // namespace understory
