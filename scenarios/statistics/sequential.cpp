#include "scenarios/statistics/sequential.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace understory {

SignCounts signs_of(const PairedOutcomes& outcomes) {
  return {static_cast<double>(outcomes.only_second), static_cast<double>(outcomes.both + outcomes.neither),
          static_cast<double>(outcomes.only_first)};
}

double log_evidence_above(const SignCounts& counts, double null) {
  constexpr int bets = 20;
  std::array<double, bets> logs;
  for (int k = 0; k < bets; ++k) {
    const double share = (k + 1.0) / bets, up = share * (1 - null) / (1 + null),
                 even = -share * null / (1 + null);
    const auto power = [](double count, double gain) { return count > 0 ? count * std::log1p(gain) : 0; };
    logs[static_cast<std::size_t>(k)] =
        power(counts.up, up) + power(counts.even, even) + power(counts.down, -share);
  }
  const double largest = *std::ranges::max_element(logs);
  double sum = 0;
  for (const double one : logs) sum += std::exp(one - largest);
  return largest + std::log(sum / bets);
}

double sequential_lower_end(const SignCounts& counts, double alpha) {
  double refuted = -1, open = 1;  // the evidence falls as the null rises
  while (open - refuted > 1e-9) {
    const double null = (refuted + open) / 2;
    (log_evidence_above(counts, null) >= -std::log(alpha) ? refuted : open) = null;
  }
  return refuted;
}

double none_seen_upper_end(int trials, double alpha) {
  return trials == 0 ? 1 : 1 - std::pow(alpha, 1.0 / trials);
}

}  // namespace understory
