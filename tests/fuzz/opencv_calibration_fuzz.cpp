#include "perception/io/calibration/calibration_file.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

/// XML, YAML or what is taken for a rig file, as its bytes say; in metres and, with a size beside it, in
/// centimetres.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  static const std::filesystem::path file = fuzz::folder() / "calibration";
  fuzz::write(file, fuzz::text_of(data, size));
  fuzz::expect_rig_or_complaint([] { return read_calibrated_rig(file, {}).rig; });
  fuzz::expect_rig_or_complaint([] { return read_calibrated_rig(file, {0.01, 376, 240, 4.8}).rig; });
  return 0;
}
