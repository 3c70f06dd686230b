#include <cmath>

#include "scenarios/course/inventory.hpp"
#include "tests/fuzz/recorded_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  const std::string text(fuzz::text_of(data, size));
  fuzz::expect_result_or_complaint([&] { return stems_in_text(text, "fuzzed"); },
                                   [](const std::vector<Stem>& stems) {
                                     for (const Stem& stem : stems)
                                       fuzz::require(stem.place_m.allFinite() && stem.diameter_m > 0 &&
                                                         std::isfinite(stem.known.height_m) &&
                                                         (!stem.known.lean || stem.known.lean->allFinite()),
                                                     "a stem somewhere, with a thickness");
                                     fuzz::require(!stems.empty(), "at least one stem");
                                   });
  return 0;
}
