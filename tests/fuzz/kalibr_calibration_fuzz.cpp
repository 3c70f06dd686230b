#include "perception/io/calibration/calibration_file.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

/// A camchain.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  static const std::filesystem::path file = fuzz::folder() / "camchain.yaml";
  fuzz::write(file, fuzz::text_of(data, size));
  fuzz::expect_rig_or_complaint([] { return read_calibrated_rig(file, {}).rig; });
  return 0;
}
