#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "perception/io/text_table.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/report/table.hpp"
#include "tests/validation/sections.hpp"

/// How often the gate errs: real flights before and after three real changes, drawn again and again.
namespace understory {
namespace {

constexpr int runs = 2000, least_pairs = 50, most_pairs = 1500;
constexpr std::array<double, 3> margins{0.02, 0.05, 0.10};

/// 1, 0 or -1 of each condition, at one seed.
using Round = std::vector<int>;

/// A change, as the flights of every seed came out.
struct Change {
  std::string name;
  std::vector<Round> rounds;

  double fall() const {
    double sum = 0, count = 0;
    for (const Round& round : rounds)
      for (const int one : round) sum -= one, ++count;
    return sum / count;
  }
  double discordance() const {
    double sum = 0, count = 0;
    for (const Round& round : rounds)
      for (const int one : round) sum += one != 0, ++count;
    return sum / count;
  }
};

/// docs/results/gate/outcomes.csv: scenario, seed, and for the program before and after each change whether
/// the flight reached its goal.
std::vector<Change> real_changes() {
  const std::string file = UNDERSTORY_SOURCE_DIR "/docs/results/gate/outcomes.csv";
  const Table table = table_from_csv(read_file(file, 1 << 20), file);
  std::vector<Change> changes;
  for (std::size_t column = 3; column < table.head.size(); ++column) {
    std::map<std::string, Round> by_seed;
    for (const std::vector<std::string>& row : table.rows)
      by_seed[row[1]].push_back((row[column] == "1") - (row[2] == "1"));
    Change& change = changes.emplace_back(Change{table.head[column], {}});
    for (auto& [seed, round] : by_seed) change.rounds.push_back(std::move(round));
  }
  return changes;
}

double drawn(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

/// The pairs of one run, in the order in which they are flown: whole seeds. `fall`: if given, the change is
/// made one that lowers success by exactly this: gains and losses by the throw of a coin, then goals that are
/// lost.
std::vector<Round> resampled(const Change& change, std::optional<double> fall, std::mt19937_64& generator) {
  std::vector<Round> rounds;
  const double ties = 1 - change.discordance();
  for (int pairs = 0; pairs < most_pairs; pairs += static_cast<int>(rounds.back().size())) {
    Round& round = rounds.emplace_back(change.rounds[generator() % change.rounds.size()]);
    if (!fall) continue;
    for (int& one : round) {
      if (one != 0) one = drawn(generator) < 0.5 ? 1 : -1;
      if (one == 0 && drawn(generator) < *fall / ties) one = -1;
    }
  }
  return rounds;
}

/// What the gate says of one run, looked at after about every ten pairs, and after how many.
std::pair<Verdict, int> judged(const std::vector<Round>& rounds, const GateRule& rule) {
  GateCounts counts{{}, std::vector<SignCounts>(rounds[0].size())};
  int next_look = least_pairs;
  for (const Round& round : rounds) {
    for (std::size_t i = 0; i < round.size(); ++i)
      for (SignCounts* signs : {&counts.all, &counts.conditions[i]})
        (round[i] > 0 ? signs->up : round[i] < 0 ? signs->down : signs->even) += 1;
    if (counts.all.total() < next_look) continue;
    next_look += 10;
    const Verdict verdict = verdict_on(counts, rule);
    if (verdict != Verdict::undecided) return {verdict, static_cast<int>(counts.all.total())};
  }
  return {Verdict::undecided, most_pairs};
}

/// One look at a number of pairs fixed beforehand, with the same alpha: the normal test of the mean
/// difference.
bool shown_at(const std::vector<Round>& rounds, int pairs, Verdict verdict, const GateRule& rule) {
  double n = 0, sum = 0, squares = 0;
  for (const Round& round : rounds)
    for (const int one : round)
      if (n < pairs) ++n, sum += one, squares += one * one;
  const double mean = sum / n, error = std::sqrt((squares / n - mean * mean + 1 / (n * n)) / n);
  return verdict == Verdict::worse ? mean + normal_quantile(1 - rule.alpha) * error < 0
                                   : mean - normal_quantile(1 - rule.alpha) * error > -rule.margin;
}

/// Over many runs.
struct Verdicts {
  double not_worse = 0, worse = 0, mean_pairs = 0, most_of_pairs = 0;  ///< shares; pairs, of 80 % of the runs
  int fixed_pairs = 0;  ///< of one look that shows as often what is shown more often; 0: not by most_pairs
};

Verdicts simulated(const Change& change, std::optional<double> fall, const GateRule& rule,
                  bool compare = false) {
  std::mt19937_64 generator(48);
  Verdicts outcome;
  std::vector<double> pairs;
  std::vector<std::vector<Round>> all;
  for (int run = 0; run < runs; ++run) {
    const std::vector<Round>& rounds = all.emplace_back(resampled(change, fall, generator));
    const auto [verdict, count] = judged(rounds, rule);
    outcome.not_worse += (verdict == Verdict::not_worse) / static_cast<double>(runs);
    outcome.worse += (verdict == Verdict::worse) / static_cast<double>(runs);
    pairs.push_back(count);
  }
  outcome.mean_pairs = mean_of(pairs);
  outcome.most_of_pairs = quantile(pairs, 0.8);
  const Verdict usual = outcome.worse > outcome.not_worse ? Verdict::worse : Verdict::not_worse;
  const double power = std::max(outcome.worse, outcome.not_worse);
  for (int n = 10; compare && n <= most_pairs && outcome.fixed_pairs == 0; n += 10)
    if (std::ranges::count_if(all, [&](const auto& rounds) { return shown_at(rounds, n, usual, rule); }) >=
        power * runs)
      outcome.fixed_pairs = n;
  return outcome;
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

}  // namespace

Section gate_section() {
  Section section{"gate"};
  const std::vector<Change> changes = real_changes();
  double false_alarm = 0, false_pass = 0, saved = 0;
  LinePlot plot{.title = "Pairs until the verdict", .x_label = "margin, points", .y_label = "pairs"};
  int compared = 0;
  for (const Change& change : changes) {
    Series mean{.name = change.name},
        fixed{.name = change.name + ", number fixed beforehand", .mark = Mark::dashes};
    mean.mark = Mark::line_and_dots;
    for (const double margin : margins) {
      const GateRule rule{.margin = margin};
      const Verdicts as_is = simulated(change, {}, rule, true);
      const Verdicts without = simulated(change, 0.0, rule), at_margin = simulated(change, margin, rule);
      false_alarm = std::max(false_alarm, without.worse);
      false_pass = std::max(false_pass, at_margin.not_worse);
      std::string less = "-";
      if (as_is.fixed_pairs > 0) {
        const double share = 1 - as_is.mean_pairs / as_is.fixed_pairs;
        less = fmt::format("{:.0f} %", 100 * share);
        saved += share, ++compared;
      }
      section.row("table", fmt::format("{} | {:.0f} | {} | {} | {:.0f} | {:.0f} | {} | {} | {} | {}",
                                       change.name, 100 * margin, percent(as_is.not_worse),
                                       percent(as_is.worse), as_is.mean_pairs, as_is.most_of_pairs,
                                       as_is.fixed_pairs > 0 ? fmt::format("{}", as_is.fixed_pairs)
                                                             : fmt::format("over {}", most_pairs),
                                       less, percent(without.worse), percent(at_margin.not_worse)));
      mean.x.push_back(100 * margin), mean.y.push_back(as_is.mean_pairs);
      fixed.x.push_back(100 * margin);
      fixed.y.push_back(as_is.fixed_pairs > 0 ? as_is.fixed_pairs : std::nan(""));
    }
    fixed.colour = mean.colour = static_cast<int>(plot.series.size() / 2);
    plot.series.push_back(mean), plot.series.push_back(fixed);
    section.row("changes",
                fmt::format("{} | {} | {} | {}", change.name, change.rounds.size() * change.rounds[0].size(),
                            percent(change.discordance()), percent(change.fall())));
  }
  section.blocks["false_alarm"] = percent(false_alarm);
  section.blocks["false_pass"] = percent(false_pass);
  section.blocks["saved"] = fmt::format("{:.0f} %", 100 * saved / std::max(1, compared));
  section.pictures["pairs"] = to_svg({plot});
  section.checks = {at_most("called worse though nothing fell, share of changes", false_alarm, 0.05, ""),
                    at_most("called not worse though success fell by the margin", false_pass, 0.05, "")};
  return section;
}

}  // namespace understory
