#include "perception/io/image_sequence.hpp"
#include "tests/fuzz/recorded_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  const std::string_view text = fuzz::text_of(data, size);
  const auto check = [](const std::vector<EurocImage>& images) {
    for (std::size_t i = 0; i < images.size(); ++i) {
      fuzz::require(i == 0 || images[i].t_ns > images[i - 1].t_ns, "times that increase");
      fuzz::require(!images[i].file_name.empty() && images[i].file_name.find('/') == std::string::npos,
                    "a name within the folder");
    }
  };
  fuzz::expect_result_or_complaint([&] { return parse_euroc_images(text, "fuzzed"); }, check);
  return 0;
}
