#include "scenarios/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "scenarios/bench/bench_cases.hpp"

namespace understory {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int passes_in_turn = 10;

double percentile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::vector<BenchRow> bench_detectors(const CalibratedRig& rig, const std::vector<StereoFrame>& frames,
                                      const BenchOptions& options) {
  const BenchPairs pairs = bench_pairs(rig, frames);
  std::vector<BenchCase> cases = bench_cases(rig, pairs);
  std::vector<std::vector<double>> times_ms(cases.size());
  for (int round = 0; round < options.rounds; ++round) {
    options.on_progress(round, options.rounds);
    for (std::size_t c = 0; c < cases.size(); ++c) {
      if (round % cases[c].every_rounds != 0) continue;
      const int passes = cases[c].every_rounds > 1 ? 1 : passes_in_turn;
      for (std::size_t i = 0; i < frames.size(); ++i)
        cases[c].run(i);  // not timed: what ran before is forgotten
      for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t i = 0; i < frames.size(); ++i) {
          const auto before = Clock::now();
          cases[c].run(i);
          times_ms[c].push_back(std::chrono::duration<double, std::milli>(Clock::now() - before).count());
        }
      }
    }
  }
  std::vector<BenchRow> rows;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    BenchRow row{cases[c].name,
                 cases[c].threads,
                 percentile(times_ms[c], 0.5),
                 percentile(times_ms[c], 0.9),
                 percentile(times_ms[c], 0.99),
                 cases[c].yardstick,
                 0};
    for (const BenchRow& other : rows)
      if (other.name == row.yardstick) row.ratio = row.median_ms / other.median_ms;
    rows.push_back(row);
  }
  return rows;
}

std::string to_table(const std::vector<BenchRow>& rows) {
  std::string text =
      fmt::format("{:<44}{:>8}{:>11}{:>9}{:>9}  {}\n", "", "threads", "median ms", "p90", "p99", "against");
  for (const BenchRow& row : rows) {
    text += fmt::format("{:<44}{:>8}{:>11.4f}{:>9.4f}{:>9.4f}", row.name, row.threads, row.median_ms,
                        row.p90_ms, row.p99_ms);
    if (row.ratio > 0 && row.ratio < 0.05)
      text += fmt::format("  {:.0f} times faster than {}", 1 / row.ratio, row.yardstick);
    else if (row.ratio > 0)
      text += fmt::format("  {:.2f} of {}", row.ratio, row.yardstick);
    text += "\n";
  }
  return text;
}

std::string to_json(const std::vector<BenchRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const BenchRow& row : rows) {
    nlohmann::ordered_json one{{"name", row.name},     {"threads", row.threads}, {"median_ms", row.median_ms},
                               {"p90_ms", row.p90_ms}, {"p99_ms", row.p99_ms},   {"yardstick", nullptr},
                               {"ratio", nullptr}};
    if (row.ratio > 0) one["yardstick"] = row.yardstick, one["ratio"] = row.ratio;
    list.push_back(one);
  }
  return list.dump(2) + "\n";
}

}  // namespace understory
