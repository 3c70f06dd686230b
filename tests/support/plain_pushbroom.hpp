#pragma once

#include <cstdint>
#include <vector>

#include "perception/gray_view.hpp"
#include "perception/pushbroom/pushbroom_kernel.hpp"

/// The detector's rule written plainly, one block after the other: what the fast kernel must equal bit for
/// bit. No image library, so that it runs wherever the kernel does.
namespace understory::support {

/// The Laplacian of kernel size 3, kernel [2 0 2; 0 -8 0; 2 0 2], borders mirrored about the outermost pixel,
/// saturated to 8 bits (negative responses become 0, large ones 255): what cv::Laplacian(..., CV_8U, 3)
/// gives. `edges` is resized to width * height, rows packed. Images are at least 2x2.
void edge_map(const GrayView& image, std::vector<std::uint8_t>& edges);
GrayView view_of(const std::vector<std::uint8_t>& packed, int width_px, int height_px);

/// Every block that passes `rule`, in the kernel's order.
std::vector<BlockMatch> plain_matches(const BlockRule& rule, const GrayView& left, const GrayView& right);

}  // namespace understory::support
