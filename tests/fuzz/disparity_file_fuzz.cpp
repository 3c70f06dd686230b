#include "scenarios/evaluation/disparity_files.hpp"
#include "tests/fuzz/recorded_text.hpp"

/// The first byte chooses PFM, parsed as it is, or PNG, which the image library decodes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  if (size == 0) return 0;
  const std::string bytes(fuzz::text_of(data + 1, size - 1));
  const auto check = [](const cv::Mat& disparity) {
    fuzz::require(disparity.type() == CV_32FC1 && !disparity.empty(), "an image of disparities");
  };
  if (data[0] % 2 == 0) {
    fuzz::expect_result_or_complaint([&] { return parse_pfm(bytes, "fuzzed"); }, check);
    return 0;
  }
  static const std::filesystem::path file = fuzz::folder() / "disparity.png";
  fuzz::write(file, bytes);
  fuzz::expect_result_or_complaint([] { return read_disparity_file(file); }, check, file.string());
  return 0;
}
