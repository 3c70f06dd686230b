#include <cmath>

#include "scenarios/evaluation/evaluation_recording.hpp"
#include "tests/fuzz/recorded_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  const std::string text(fuzz::text_of(data, size));
  fuzz::expect_result_or_complaint(
      [&] { return parse_recorded_objects(text, "fuzzed"); },
      [](const std::vector<RecordedObject>& objects) {
        for (const RecordedObject& object : objects)
          fuzz::require(object.number > 0 && object.from_world.allFinite() && object.to_world.allFinite() &&
                            std::isfinite(object.radius_m) && object.radius_m >= 0,
                        "a bar somewhere, its number above that of nothing");
      });
  return 0;
}
