#include "perception/io/calibration/calibration_file.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

/// Both cameras' files in one input, cut apart at the first line of '='.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  static const std::array<std::filesystem::path, 2> files{fuzz::folder() / "left.yaml",
                                                          fuzz::folder() / "right.yaml"};
  constexpr std::string_view cut = "====\n";
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t at = text.find(cut);
  fuzz::write(files[0], text.substr(0, at));
  fuzz::write(files[1], at == std::string_view::npos ? text : text.substr(at + cut.size()));
  fuzz::expect_rig_or_complaint([] { return read_calibrated_rig(files[0], {}).rig; });
  return 0;
}
