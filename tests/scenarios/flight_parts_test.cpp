#include "scenarios/flight/flight_computer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "scenarios/flight/flight_result.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/support/text.hpp"

namespace understory {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

/// The moment of a camera's frame, and of a physics step.
std::int64_t frame_ns(std::int64_t i, std::int64_t rate_hz = 120) { return i * second_ns / rate_hz; }

/// What came out, and when it was noticed.
struct Result {
  std::int64_t frame_ns, noticed_ns;
};

/// A second of a camera at 120 Hz, asked at every physics step; arrivals `latency_ns` after the frame's time.
std::vector<Result> a_second(std::int64_t cost_ns, std::int64_t latency_ns) {
  FlightComputer computer(cost_ns);
  std::vector<Result> results;
  for (std::int64_t step = 0; step < 1200; ++step) {
    const std::int64_t now_ns = frame_ns(step, 1200);
    if (step % 10 == 0) computer.send({now_ns, {}, {}}, now_ns + latency_ns);
    while (const auto frame = computer.next_frame(now_ns)) results.push_back({frame->t_ns, now_ns});
  }
  return results;
}

TEST(FlightComputer, WithoutCostHandsOverEveryFrameAsItArrives) {
  const std::vector<Result> results = a_second(0, 8'000'000);
  ASSERT_EQ(results.size(), 119u);  // the last one is on its way
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].frame_ns, frame_ns(static_cast<std::int64_t>(i)));
    EXPECT_EQ(results[i].noticed_ns,
              results[i].frame_ns + 8'333'333 + (i % 3 == 2 ? 1 : 0));  // the next step
  }
}

TEST(FlightComputer, KeepsUpWithACameraThatIsSlower) {
  // 8.3 ms of work in 8.33 ms: every frame, 16.3 ms old.
  const std::vector<Result> results = a_second(8'300'000, 8'000'000);
  ASSERT_EQ(results.size(), 118u);
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].frame_ns, frame_ns(static_cast<std::int64_t>(i)));
    EXPECT_GE(results[i].noticed_ns - results[i].frame_ns, 16'300'000);
    EXPECT_LT(results[i].noticed_ns - results[i].frame_ns, 16'300'000 + 833'334);
  }
}

TEST(FlightComputer, ThirtyMillisecondsAFrameGiveTheNewestThirtyThreeTimesASecond) {
  const std::int64_t cost_ns = 30'000'000;
  const std::vector<Result> results = a_second(cost_ns, 0);
  ASSERT_EQ(results.size(), 33u);  // work begins at 0, 30, 60 ms ...: done by 30, 60, ... 990 ms
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::int64_t start_ns = static_cast<std::int64_t>(i) * cost_ns;
    const std::int64_t newest = start_ns * 120 / second_ns;  // exposed by then
    EXPECT_EQ(results[i].frame_ns, frame_ns(newest)) << i;
    EXPECT_GE(results[i].noticed_ns, start_ns + cost_ns);
    EXPECT_LT(results[i].noticed_ns, start_ns + cost_ns + 833'334);
  }
}

TEST(FlightComputer, WaitsWhereNothingArrives) {
  FlightComputer computer(10);
  EXPECT_FALSE(computer.next_frame(100));
  computer.send({1, {}, {}}, 105);
  EXPECT_FALSE(computer.next_frame(104));
  EXPECT_FALSE(computer.next_frame(114));
  const auto frame = computer.next_frame(115);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->t_ns, 1);
  EXPECT_FALSE(computer.next_frame(1000));
}

TEST(FlightComputer, ForeseesWhichFramesItWillTake) {
  std::mt19937 generator(1);
  for (int trial = 0; trial < 200; ++trial) {
    const std::int64_t cost_ns = std::uniform_int_distribution<std::int64_t>(1, 120'000'000)(generator);
    const std::int64_t latency_ns = std::uniform_int_distribution<std::int64_t>(0, 60'000'000)(generator);
    FlightComputer computer(cost_ns);
    std::vector<std::int64_t> foreseen, taken;
    for (std::int64_t step = 0; step < 1200; ++step) {
      const std::int64_t now_ns = frame_ns(step, 1200);
      if (step % 10 == 0) {
        if (computer.will_take(now_ns + latency_ns, frame_ns(step + 10, 1200) + latency_ns))
          foreseen.push_back(now_ns);
        computer.send({now_ns, {}, {}}, now_ns + latency_ns);
      }
      while (const auto frame = computer.next_frame(now_ns)) taken.push_back(frame->t_ns);
    }
    ASSERT_LE(taken.size(), foreseen.size());
    foreseen.resize(taken.size());  // the rest is still on its way
    EXPECT_EQ(taken, foreseen) << cost_ns << " ns, " << latency_ns << " ns late";
  }
}

TEST(Compute, CostsAreTheDetectorsTimesTheFactor) {
  const auto cost_s = [](const std::vector<std::string>& settings) {
    return scenario_from_text("{}", "here", settings).perception.cost_s();
  };
  EXPECT_EQ(cost_s({}), 0);
  EXPECT_EQ(cost_s({"perception.detector=stereo_bm"}), 0);
  const std::string on = "perception.compute.enabled=true";
  EXPECT_DOUBLE_EQ(cost_s({on}), 0.0083);
  EXPECT_LT(cost_s({on}), 1.0 / 120);
  EXPECT_NEAR(cost_s({on, "perception.pushbroom.stride_px=2"}) / 0.0083, 3.95, 0.01);
  EXPECT_DOUBLE_EQ(cost_s({on, "perception.detector=stereo_bm", "perception.compute.factor=2",
                           "perception.compute.stereo_bm_s=0.03"}),
                   0.06);
  EXPECT_EQ(cost_s({on, "perception.detector=true_depth"}), 0);
  EXPECT_EQ(cost_s({on, "perception.detector=none"}), 0);
}

TEST(Compute, PlansShareACoreWithTheFilter) {
  const auto cost = [](const std::vector<std::string>& settings) {
    return scenario_from_text("{}", "here", settings).perception.compute.plan_cost(200);
  };
  EXPECT_EQ(cost({}).step_s, 0);
  // The filter takes 10 * 0.1 ms of each 5 ms: a plan takes 1 / 0.8 as long as alone.
  const PlanCost shared = cost({"perception.compute.enabled=true", "perception.compute.factor=10",
                                "perception.compute.plan_step_s=1e-6", "perception.compute.plan_point_s=2e-7",
                                "perception.compute.filter_s=1e-4"});
  EXPECT_NEAR(shared.step_s, 1.25e-5, 1e-12);
  EXPECT_NEAR(shared.point_s, 2.5e-6, 1e-12);
}

TEST(Compute, FramesThatWouldComeTooLateForTheEstimatorAreRefused) {
  const auto refused = [] {
    scenario_from_text("perception: {detector: stereo_sgbm, compute: {enabled: true, factor: 100}}", "here");
  };
  support::expect_part(support::refusal_of<ScenarioError>(refused),
                       "perception.compute.factor: a frame must be processed");
}

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
  result.outcome = Outcome::collision;
  result.seed = 12;
  result.minimum_clearance_m = std::numeric_limits<double>::infinity();
  result.timings = {{"detect", 2, 0.004, 0.003}};
  const auto json = nlohmann::json::parse(to_json(result));
  EXPECT_EQ(json["outcome"], "collision");
  EXPECT_EQ(json["seed"], 12);
  EXPECT_TRUE(json["minimum_clearance_m"].is_null());
  EXPECT_NEAR(json["timings"]["detect"]["mean_ms"].get<double>(), 2.0, 1e-12);
  EXPECT_EQ(json["solved"], 0);
}

}  // namespace
}  // namespace understory
