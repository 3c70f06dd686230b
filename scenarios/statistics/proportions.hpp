#pragma once

#include <cstdint>

namespace understory {

/// A count out of a total.
struct Share {
  std::int64_t of = 0;
  std::int64_t with = 0;

  void count(bool has) {
    ++of;
    with += has;
  }
  void add(const Share& other) {
    of += other.of;
    with += other.with;
  }
  /// 0 .. 1; 0 of nothing.
  double value() const { return of > 0 ? static_cast<double>(with) / static_cast<double>(of) : 0; }
};

struct Interval {
  double minimum = 0;
  double maximum = 1;
};

/// The normal quantile of 95 % intervals: what every interval of this folder has unless it says otherwise.
inline constexpr double z_95 = 1.959963984540054;

/// Wilson's score interval for a proportion (Wilson 1927, J. Am. Stat. Assoc. 22), 95 %, without continuity
/// correction. No trials: 0 .. 1.
Interval wilson_interval(int successes, int trials);

/// The same trials made twice, each time good or bad: how often both were good, only one, none.
struct PairedOutcomes {
  int both = 0;
  int only_first = 0;
  int only_second = 0;
  int neither = 0;

  int pairs() const { return both + only_first + only_second + neither; }
  int first() const { return both + only_first; }
  int second() const { return both + only_second; }
  /// Share of the second less share of the first; 0 without pairs.
  double difference() const {
    return pairs() == 0 ? 0 : static_cast<double>(only_second - only_first) / pairs();
  }
};

/// Two-sided p value that both shares are the same: the exact form of McNemar's test (McNemar 1947,
/// Psychometrika 12), in which the pairs that changed split as a fair coin would. 1 where none changed. It is
/// conservative with few changed pairs: with five it cannot fall below 0.0625.
double mcnemar_exact_p(const PairedOutcomes& outcomes);

/// 95 % interval of difference(): Newcombe's method 10 (Newcombe 1998, Statistics in Medicine 17, 2635),
/// Wilson intervals of both shares put together with the correlation of the pairs, corrected for continuity.
/// -1 .. 1 without pairs.
Interval paired_difference_interval(const PairedOutcomes& outcomes);

}  // namespace understory
