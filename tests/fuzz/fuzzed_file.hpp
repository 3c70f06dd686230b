#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

#include "perception/stereo_rig.hpp"

namespace understory::fuzz {

/// A folder of this process's own, in $TMPDIR, made on the first call.
const std::filesystem::path& folder();

void write(const std::filesystem::path& file, std::string_view bytes);

/// The bytes as text.
inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Reads; aborts where that ends in anything but a rig that a detector takes or one line of complaint.
void expect_rig_or_complaint(const std::function<StereoRig()>& read);

}  // namespace understory::fuzz
