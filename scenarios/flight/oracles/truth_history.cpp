#include "scenarios/flight/oracles/truth_history.hpp"

#include <algorithm>

#include "scenarios/output/require.hpp"

namespace understory {

void TruthHistory::observe(const Truth& truth) {
  moments_.push_back(truth);
  while (moments_.front().t_ns + 600'000'000 < truth.t_ns) moments_.pop_front();
}

const Truth& TruthHistory::at(std::int64_t t_ns) const {
  require(!moments_.empty(), "a truth was observed before it is asked for");
  const auto later = std::upper_bound(moments_.begin(), moments_.end(), t_ns,
                                      [](std::int64_t t, const Truth& truth) { return t < truth.t_ns; });
  return later == moments_.begin() ? *later : *std::prev(later);
}

}  // namespace understory
