#include "scenarios/recording/carried_path.hpp"
#include "tests/fuzz/recorded_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  static const std::filesystem::path file = fuzz::folder() / "path.csv";
  fuzz::write(file, fuzz::text_of(data, size));
  fuzz::expect_result_or_complaint([] { return read_path(file); },
                                   [](const std::vector<TimedPose>& poses) {
                                     fuzz::require(poses.size() >= 2, "two poses to go between");
                                     fuzz::check_poses(poses);
                                     fuzz::require(!thinned(poses).empty(), "poses left");
                                   },
                                   file.native());
  return 0;
}
