#include "perception/io/image_file.hpp"
#include "tests/fuzz/recorded_text.hpp"

/// Any bytes under an image's name: the library tells the format by what they hold.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  static const std::filesystem::path file = fuzz::folder() / "image.png";
  fuzz::write(file, fuzz::text_of(data, size));
  const auto check = [](const cv::Mat& image) {
    fuzz::require(image.type() == CV_8UC1 && !image.empty(), "an 8-bit gray image");
  };
  fuzz::expect_result_or_complaint([] { return read_gray_image(file); }, check, file.string());
  return 0;
}
