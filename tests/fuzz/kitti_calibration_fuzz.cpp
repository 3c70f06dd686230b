#include "perception/io/calibration/calibration_file.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

/// calib.txt or calib_cam_to_cam.txt.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  static const std::filesystem::path file = fuzz::folder() / "calib.txt";
  fuzz::write(file, fuzz::text_of(data, size));
  fuzz::expect_rig_or_complaint([] { return read_calibrated_rig(file, {}).rig; });
  fuzz::expect_rig_or_complaint([] {
    CalibrationOptions options;
    options.images_at_hand = cv::Size(1242, 375);
    options.of_colour_pair = true;
    return read_calibrated_rig(file, options).rig;
  });
  return 0;
}
