#include "tests/fuzz/recorded_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  const std::string_view text = fuzz::text_of(data, size);
  fuzz::expect_result_or_complaint([&] { return parse_poses(text, "fuzzed"); }, fuzz::check_poses);
  return 0;
}
