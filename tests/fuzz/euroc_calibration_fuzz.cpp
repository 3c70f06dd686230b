#include "perception/io/calibration/calibration_file.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

/// Both cameras' sensor.yaml in one input, cut apart at the first line of '='.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  static const std::filesystem::path folder = [] {
    for (const char* camera : {"cam0", "cam1"}) std::filesystem::create_directories(fuzz::folder() / camera);
    return fuzz::folder();
  }();
  constexpr std::string_view cut = "====\n";
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t at = text.find(cut);
  const std::string_view left = text.substr(0, at);
  const std::string_view right = at == std::string_view::npos ? left : text.substr(at + cut.size());
  fuzz::write(folder / "cam0" / "sensor.yaml", left);
  fuzz::write(folder / "cam1" / "sensor.yaml", right);
  fuzz::expect_rig_or_complaint([] { return read_calibrated_rig(folder, {}).rig; });
  return 0;
}
