#pragma once

#include <optional>
#include <string>

#include "perception/io/calibration_file.hpp"

namespace understory {

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
};

/// What the file says, else what the options say. Throws as throw_file_fault does where nobody says it, where
/// the two differ, or where the options' size is none.
ImageSize agreed_image_size(const std::string& file, std::optional<ImageSize> of_file,
                            const CalibrationOptions& options);

}  // namespace understory
