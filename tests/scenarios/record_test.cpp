#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "scenarios/flight/flight_result.hpp"

namespace understory {
namespace {

TEST(RunDigest, EveryBitAndTheOrderCount) {
  const auto digest = [](auto... words) {
    RunDigest running;
    (running.add(words), ...);
    return running.hex();
  };
  EXPECT_EQ(digest(1.0, 2.0), digest(1.0, 2.0));
  EXPECT_NE(digest(1.0, 2.0), digest(2.0, 1.0));
  EXPECT_NE(digest(1.0), digest(std::nextafter(1.0, 2.0)));
  EXPECT_NE(digest(0.0), digest(-0.0));
  EXPECT_EQ(digest().size(), 16u);
  std::vector<std::byte> image(1001);
  const auto hash = [&] {
    RunDigest running;
    running.add(std::span<const std::byte>(image));
    return running.hex();
  };
  std::set<std::string> hashes{hash()};
  for (std::size_t at = 0; at < image.size(); ++at) {  // in every chain, and in what is left over
    image[at] = std::byte{1};
    hashes.insert(hash());
    image[at] = std::byte{};
  }
  EXPECT_EQ(hashes.size(), image.size() + 1);
  for (std::size_t at = 0; at + 64 < image.size();
       ++at) {  // neighbours and those a round apart change places
    image[at] = std::byte{2};
    image[at + 1] = image[at + 8] = image[at + 64] = std::byte{3};
    hashes.insert(hash());
    image[at] = image[at + 1] = image[at + 8] = image[at + 64] = std::byte{};
  }
  EXPECT_EQ(hashes.size(), 2 * image.size() + 1 - 64);
}

TEST(FlightResult, JsonSaysWhatHappened) {
  FlightResult result;
  result.ending = Ending::collision;
  result.seed = 12;
  result.min_clearance_m = std::numeric_limits<double>::infinity();
  result.timings = {{"detect", 2, 0.004, 0.003}};
  const auto json = nlohmann::json::parse(to_json(result));
  EXPECT_EQ(json["outcome"], "collision");
  EXPECT_EQ(json["seed"], 12);
  EXPECT_TRUE(json["min_clearance_m"].is_null());
  EXPECT_NEAR(json["timings"]["detect"]["mean_ms"].get<double>(), 2.0, 1e-12);
  EXPECT_EQ(json["replans"]["solved"], 0);
}

}  // namespace
}  // namespace understory
