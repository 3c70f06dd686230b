// The filter allocates nothing once its history is full.
#include <gtest/gtest.h>

#include "estimation/filter.hpp"
#include "simulated_flight.hpp"
#include "tests/support/counted_allocations.hpp"

namespace understory::test {
namespace {

using support::allocation_count;

TEST(Allocation, TheFilterAllocatesNothingAfterTheFirstSecond) {
  const std::vector<Moment> flight = fly(dodge(), 3.2);
  for (const FilterConfig& config : {FilterConfig{}, windy_filter(), original_filter()}) {
    Filter filter(config);
    Sensors sensors({}, 1);
    const long at_first = allocation_count;
    long after_a_second = 0;
    for (std::size_t i = 0; i < flight.size(); ++i) {
      if (i == 201) after_a_second = allocation_count;
      sensors.feed(filter, flight[i]);
      if (i % 20 != 0 || i < 200) continue;
      filter.on(GpsSample{flight[i - 40].t_ns, flight[i - 40].T_world_body.translation(),
                          flight[i - 40].T_world_body.linear() * flight[i - 40].velocity_body});
      filter.on(ResightingSample{flight[i - 10].t_ns, flight[i - 90].t_ns, Eigen::Vector2d::Zero(),
                                 0.04 * Eigen::Matrix2d::Identity()});
    }
    EXPECT_GT(after_a_second, at_first);  // the history's growth, so the count does count
    EXPECT_EQ(allocation_count, after_a_second);
  }
}

}  // namespace
}  // namespace understory::test
