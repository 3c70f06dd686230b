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

constexpr int runs = 2000, most_pairs = 1500;
constexpr std::array<double, 3> margins{0.02, 0.05, 0.10};

/// 1, 0 or -1 of each condition, once.
using Round = std::vector<int>;

/// A change, as the pairs of each condition came out: 1, 0 or -1.
struct Change {
  std::string name;
  std::vector<std::vector<int>> conditions;

  /// The mean over all pairs of what `of` makes of one.
  double mean(double (*of)(int)) const {
    double sum = 0, count = 0;
    for (const std::vector<int>& pairs : conditions)
      for (const int one : pairs) sum += of(one), ++count;
    return sum / count;
  }
  double fall() const {
    return mean([](int one) { return -1.0 * one; });
  }
  double discordance() const {
    return mean([](int one) { return one != 0 ? 1.0 : 0.0; });
  }
};

/// docs/results/gate/outcomes.csv: scenario, seed, and for the program before and after each change whether
/// the flight reached its goal.
std::vector<Change> real_changes() {
  const std::string file = UNDERSTORY_SOURCE_DIR "/docs/results/gate/outcomes.csv";
  const Table table = table_from_csv(read_file(file, 1 << 20), file);
  std::vector<Change> changes;
  for (std::size_t column = 3; column < table.head.size(); ++column) {
    std::map<std::string, std::vector<int>> by_scenario;
    for (const std::vector<std::string>& row : table.rows)
      by_scenario[row[0]].push_back((row[column] == "1") - (row[2] == "1"));
    Change& change = changes.emplace_back(Change{table.head[column], {}});
    for (auto& [scenario, pairs] : by_scenario) change.conditions.push_back(std::move(pairs));
  }
  return changes;
}

double drawn(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

/// Where pairs are drawn from: the change as it is; without effect (a coin decides which side was before), or
/// made one that lowers success by `fall`: with that probability a pair of a harmful change, and what this
/// lacks in losses.
struct Source {
  const Change& change;
  const Change* harmful = nullptr;  ///< null: the change as it is
  double fall = 0;

  int pair(std::size_t condition, std::mt19937_64& generator) const {
    const auto from = [&](const Change& one) {
      return one.conditions[condition][generator() % one.conditions[condition].size()];
    };
    if (harmful == nullptr) return from(change);
    const double by_harm = std::min(fall, harmful->fall());
    const int one = drawn(generator) < by_harm / harmful->fall() ? from(*harmful)
                    : drawn(generator) < 0.5                     ? from(change)
                                                                 : -from(change);
    const double ties = 1 - harmful->discordance();
    return one == 0 && drawn(generator) < (fall - by_harm) / ties ? -1 : one;
  }
};

/// The pairs of one run, in the order in which they are flown: one of each condition, again and again.
std::vector<Round> resampled(const Source& source, std::mt19937_64& generator) {
  std::vector<Round> run;
  for (int pairs = 0; pairs < most_pairs; pairs += static_cast<int>(run.back().size()))
    for (std::size_t i = 0; i < source.change.conditions.size(); ++i) {
      if (i == 0) run.emplace_back();
      run.back().push_back(source.pair(i, generator));
    }
  return run;
}

/// What the gate says of one run, looked at after every ten pairs or so from the first seed on, and after how
/// many.
std::pair<Verdict, int> judged(const std::vector<Round>& rounds, const GateRule& rule) {
  GateCounts counts{{}, std::vector<SignCounts>(rounds[0].size())};
  int next_look = 1;
  for (const Round& round : rounds) {
    for (std::size_t i = 0; i < round.size(); ++i)
      for (SignCounts* signs : {&counts.all, &counts.conditions[i]})
        (round[i] > 0 ? signs->up : round[i] < 0 ? signs->down : signs->even) += 1;
    if (counts.all.total() < next_look) continue;
    next_look = static_cast<int>(counts.all.total()) + 10;
    const Verdict verdict = verdict_on(counts, rule);
    if (verdict != Verdict::undecided) return {verdict, static_cast<int>(counts.all.total())};
  }
  return {Verdict::undecided, most_pairs};
}

/// Tango's score test of a paired difference of shares (Tango 1998, Statistics in Medicine 17, 891): z of the
/// gains less the losses of n pairs, against a true difference.
double score_z(double gains, double losses, double n, double difference) {
  const double a = 2 * n, b = -gains - losses + (2 * n - gains + losses) * difference,
               c = -losses * difference * (1 - difference);
  const double share_lost = (std::sqrt(b * b - 4 * a * c) - b) / (2 * a);
  const double variance = n * (2 * share_lost + difference * (1 - difference));
  return variance > 0 ? (gains - losses - n * difference) / std::sqrt(variance) : 0;
}

/// One look at a number of pairs fixed beforehand, with the same alpha.
bool shown_at(const std::vector<Round>& rounds, int pairs, Verdict verdict, const GateRule& rule) {
  double n = 0, gains = 0, losses = 0;
  for (const Round& round : rounds)
    for (const int one : round)
      if (n < pairs) ++n, gains += one > 0, losses += one < 0;
  constexpr double z = 1.6448536;  // one-sided 5 %, as the rule's alpha
  return verdict == Verdict::worse ? score_z(gains, losses, n, 0) < -z
                                   : score_z(gains, losses, n, -rule.margin) > z;
}

/// Over many runs.
struct Verdicts {
  double not_worse = 0, worse = 0, mean_pairs = 0;
  std::vector<std::pair<Verdict, int>> runs;  ///< verdict and pairs until it

  Verdict usual() const { return worse > not_worse ? Verdict::worse : Verdict::not_worse; }
};

Verdicts simulated(const Source& source, const GateRule& rule) {
  std::mt19937_64 generator(48);
  Verdicts verdicts;
  for (int run = 0; run < runs; ++run) {
    const auto [verdict, count] = judged(resampled(source, generator), rule);
    verdicts.not_worse += (verdict == Verdict::not_worse) / static_cast<double>(runs);
    verdicts.worse += (verdict == Verdict::worse) / static_cast<double>(runs);
    verdicts.mean_pairs += count / static_cast<double>(runs);
    verdicts.runs.emplace_back(verdict, count);
  }
  return verdicts;
}

/// Pairs after which `power` of the gate's runs have this verdict. Infinite: not by most_pairs.
double enough_pairs(const Verdicts& verdicts, Verdict verdict, double power) {
  std::vector<double> until;
  for (const auto& [one, pairs] : verdicts.runs) until.push_back(one == verdict ? pairs : HUGE_VAL);
  return quantile(until, power);
}

/// Pairs that the gate flies on the mean if it stops at `most`.
double mean_pairs(const Verdicts& verdicts, double most) {
  double sum = 0;
  for (const auto& [verdict, pairs] : verdicts.runs) sum += std::min<double>(pairs, most) / runs;
  return sum;
}

/// Pairs of one look that gives this verdict with this power; 0: not by most_pairs.
int one_look(const Source& source, Verdict verdict, double power, const GateRule& rule) {
  std::mt19937_64 generator(49);
  std::vector<std::vector<Round>> all;
  for (int run = 0; run < runs; ++run) all.push_back(resampled(source, generator));
  for (int n = 10; n <= most_pairs; n += 10)
    if (std::ranges::count_if(all, [&](const auto& rounds) { return shown_at(rounds, n, verdict, rule); }) >=
        power * runs)
      return n;
  return 0;
}

/// Pairs of the gate on the mean and pairs of one look.
struct Flown {
  double gate = 0, fixed = 0;

  bool is_known() const { return std::isfinite(gate) && fixed > 0; }
  std::string text() const { return is_known() ? fmt::format("{:.0f} of {:.0f}", gate, fixed) : "-"; }
};

/// One look whose number somebody chose who knows the change, and the gate stopped where it has as much
/// power.
Flown for_known_change(const Change& change, const Verdicts& verdicts, double power, const GateRule& rule) {
  const double most = enough_pairs(verdicts, verdicts.usual(), power);
  if (!std::isfinite(most)) return {HUGE_VAL, 0};
  return {mean_pairs(verdicts, most),
          static_cast<double>(one_look(Source{change}, verdicts.usual(), power, rule))};
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

}  // namespace

Section gate_section() {
  Section section{"gate"};
  const std::vector<Change> changes = real_changes();
  double false_alarm = 0, false_pass = 0;
  std::map<double, std::vector<double>> saved;  // by power
  // Plans are made for a harmless change as discordant as the first one: the change to come is not known.
  std::vector<Flown> plans;
  for (const double margin : margins) {
    const GateRule rule{.margin = margin};
    const Source harmless{changes[0], &changes.back(), 0};
    plans.push_back({enough_pairs(simulated(harmless, rule), Verdict::not_worse, 0.9),
                     static_cast<double>(one_look(harmless, Verdict::not_worse, 0.9, rule))});
  }
  LinePlot plot{.title = "Pairs flown, on the mean",
                .x_label = "margin, points",
                .y_label = "pairs planned for a power of 90 %"};
  for (const Change& change : changes) {
    Series mean{.name = change.name + ", the gate", .mark = Mark::line_and_dots};
    for (const double margin : margins) {
      const GateRule rule{.margin = margin};
      const Verdicts as_is = simulated(Source{change}, rule);
      const Verdicts harmless = simulated(Source{change, &changes.back(), 0}, rule);
      const Verdicts at_margin = simulated(Source{change, &changes.back(), margin}, rule);
      false_alarm = std::max(false_alarm, harmless.worse);
      false_pass = std::max(false_pass, at_margin.not_worse);
      std::string cells = fmt::format("{} | {:.0f} | {} | {} | {:.0f}", change.name, 100 * margin,
                                      percent(as_is.not_worse), percent(as_is.worse), as_is.mean_pairs);
      for (const double power : {0.8, 0.9, 0.95}) {
        const Flown flown = for_known_change(change, as_is, power, rule);
        cells += " | " + flown.text();
        if (flown.is_known()) saved[power].push_back(1 - flown.gate / flown.fixed);
      }
      Flown planned = plans[mean.x.size()];
      if (planned.is_known()) planned.gate = mean_pairs(as_is, planned.gate);
      cells += " | " + planned.text();
      mean.x.push_back(100 * margin), mean.y.push_back(planned.is_known() ? planned.gate : std::nan(""));
      section.row("table",
                  cells + fmt::format(" | {} | {}", percent(harmless.worse), percent(at_margin.not_worse)));
    }
    plot.series.push_back(mean);
    section.row("changes", fmt::format("{} | {} | {} | {}", change.name,
                                       change.conditions.size() * change.conditions[0].size(),
                                       percent(change.discordance()), percent(change.fall())));
  }
  Series fixed{.name = "a number fixed beforehand", .mark = Mark::dashes};
  for (std::size_t i = 0; i < plans.size(); ++i)
    fixed.x.push_back(100 * margins[i]),
        fixed.y.push_back(plans[i].is_known() ? plans[i].fixed : std::nan(""));
  plot.series.push_back(fixed);
  section.blocks["false_alarm"] = percent(false_alarm);
  section.blocks["false_pass"] = percent(false_pass);
  for (const auto& [power, name] : {std::pair(0.8, "saved_low"), {0.9, "saved_middle"}, {0.95, "saved_high"}})
    section.blocks[name] = fmt::format("{:.0f} %", 100 * mean_of(saved[power]));
  section.pictures["pairs"] = to_svg({plot});
  section.checks = {at_most("harmless changes called worse", false_alarm, 0.05, ""),
                    at_most("changes that cost the margin called not worse", false_pass, 0.05, "")};
  return section;
}

}  // namespace understory
