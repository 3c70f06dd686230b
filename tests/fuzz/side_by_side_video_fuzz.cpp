#include "perception/io/stereo_recording.hpp"
#include "tests/fuzz/recorded_text.hpp"

/// Any bytes under a video's name: FFmpeg tells the container by what they hold. A few frames of it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  static const std::filesystem::path file = fuzz::folder() / "film.mkv";
  fuzz::write(file, fuzz::text_of(data, size));
  const auto read = [] {
    SideBySideVideo video(file);
    std::vector<StereoFrame> frames;
    for (StereoFrame frame; frames.size() < 8 && video.read(frame);) frames.push_back(frame);
    return frames;
  };
  const auto check = [](const std::vector<StereoFrame>& frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const StereoFrame& frame = frames[i];
      fuzz::require(frame.left.type() == CV_8UC1 && frame.left.size() == frames[0].left.size(),
                    "8-bit gray images of one size");
      fuzz::require(frame.right.type() == CV_8UC1 && frame.right.size() == frame.left.size(), "two alike");
      fuzz::require(i == 0 || frame.t_ns >= frames[i - 1].t_ns, "times that do not go back");
    }
  };
  fuzz::expect_result_or_complaint(read, check, file.string());
  return 0;
}
