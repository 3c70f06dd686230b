#include "scenarios/scenario/scenario_io.hpp"
#include "tests/fuzz/recorded_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  const std::string text = "course: clear\nobstacles:\n" + std::string(fuzz::text_of(data, size));
  fuzz::expect_result_or_complaint(
      [&] { return course_obstacles(scenario_from_text(text, "fuzzed")); },
      [](const std::vector<Obstacle>& obstacles) {
        for (const Obstacle& obstacle : obstacles)
          fuzz::require(obstacle.from_world.allFinite() && obstacle.to_world.allFinite() &&
                            obstacle.radius_m > 0 && std::abs(obstacle.turn_world.norm() - 1) < 1e-9,
                        "a shape somewhere, with a size");
      });
  return 0;
}
