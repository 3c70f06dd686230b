#include "perception/io/image_size.hpp"

#include <fmt/format.h>

#include "perception/io/rig_limits.hpp"
#include "perception/io/text_file.hpp"

namespace understory {

ImageSize agreed_image_size(const std::string& file, std::optional<ImageSize> of_file,
                            const CalibrationOptions& options) {
  using namespace rig_limits;
  const auto fail = [&](const std::string& expected) { throw_file_fault(file, 0, "image size", expected); };
  const auto in_range = [](int size_px) { return size_px >= minimum_size_px && size_px <= maximum_size_px; };
  if (options.width_px.has_value() != options.height_px.has_value()) fail("expected a width and a height");
  if (!options.width_px) {
    if (!of_file)
      fail("expected in the file (image_width, image_height) or with it (--size WxH), found none");
    return *of_file;
  }
  const ImageSize given{*options.width_px, *options.height_px};
  if (!in_range(given.width_px) || !in_range(given.height_px))
    fail(fmt::format("expected {} to {} px, was given {}x{}", minimum_size_px, maximum_size_px,
                     given.width_px, given.height_px));
  if (of_file && (of_file->width_px != given.width_px || of_file->height_px != given.height_px))
    fail(fmt::format("expected the file's own, {}x{}, was given {}x{}", of_file->width_px, of_file->height_px,
                     given.width_px, given.height_px));
  return given;
}

}  // namespace understory
