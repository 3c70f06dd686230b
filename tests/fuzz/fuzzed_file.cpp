#include "tests/fuzz/fuzzed_file.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "perception/pushbroom/pushbroom_stereo.hpp"

namespace understory::fuzz {
namespace {

bool is_one_line(std::string_view text) {
  constexpr std::size_t maximum = 6000;  // a path and a quotation, each cut
  if (text.empty() || text.size() > maximum) return false;
  for (const char character : text)
    if (static_cast<unsigned char>(character) < ' ') return false;
  return true;
}

}  // namespace

const std::filesystem::path& folder() {
  static const std::filesystem::path made = [] {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("understory_fuzz_" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    return path;
  }();
  return made;
}

void write(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void expect_rig_or_complaint(const std::function<StereoRig()>& read) {
  try {
    const PushbroomStereo detector(read(), PushbroomConfig());  // asserts that it can look at the rig's depth
    if (detector.one_pixel_interval().near_m < detector.detection_depth_m()) return;
    std::fprintf(stderr, "a rig whose detection depth is none\n");
  } catch (const std::runtime_error& error) {
    if (is_one_line(error.what())) return;
    std::fprintf(stderr, "not one line: %s\n", error.what());
  }
  std::abort();
}

}  // namespace understory::fuzz
