#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "perception/gray_view.hpp"

namespace understory {

/// A fixed rearrangement of the pixels of an 8-bit image, for example rectification to the nearest pixel. It
/// does what cv::remap does, but for 32 pixels at a time with byte shuffles: neighbours in the output lie
/// near each other in the source, so that a few loads hold them all. Equal to cv::remap bit for bit.
class ByteRemap {
 public:
  static constexpr int half_px = 16;                                  ///< what a load holds
  static constexpr int chunk_px = 2 * half_px;                        ///< of the output, filled at once
  static constexpr int chunk_loads = 4;                               ///< two for each half
  static constexpr std::uint8_t second_load = 0x80, as_it_is = 0xFF;  ///< in indices

  /// Tables from which apply() makes rows.
  struct Tables {
    int first_column_px = 0, last_column_px = 0;  ///< of the output
    int chunks = 0;                               ///< in a row; the last one ends with the last column
    // Two loads for each half of a chunk, whether it needs them or not: a varying number would cost more in
    // mispredicted branches. The first of the left and of the right half come first.
    std::vector<std::int32_t> offsets;    ///< of each load in the source
    AlignedVector<std::uint8_t> indices;  ///< of each pixel: 0 .. 15 in the first load, or plus second_load
    // Further loads that some halves need are added afterwards.
    std::vector<std::int32_t> more_offsets;
    std::vector<std::uint8_t> more_indices;             ///< in that load; as_it_is; or second_load for 0
    std::vector<std::int32_t> more_columns, more_rows;  ///< of the output, where each one's half begins
    std::vector<std::int32_t> more_ends;                ///< how many there are above each row, and in all
  };

  /// `places`: for each output pixel, row by row, the column and row of its source pixel; outside the source
  /// (both images are width_px x height_px) the output is 0. Width at least chunk_px. Of the output, the
  /// columns first_column_px .. last_column_px - 1 are filled, and more where they are fewer than chunk_px.
  ByteRemap(const std::vector<std::int16_t>& places, int width_px, int height_px, int first_column_px,
            int last_column_px);

  /// To be called before apply() for a source whose rows are `stride` bytes apart.
  void prepare(std::ptrdiff_t stride);

  /// Fills the output's rows first_row_px .. last_row_px - 1; `output` is its row 0, not the source itself.
  /// Threads may fill rows of one image each.
  void apply(const GrayView& source, int first_row_px, int last_row_px, std::uint8_t* output,
             std::ptrdiff_t output_stride) const;

 private:
  /// Pixels of half a chunk that one load of the source holds.
  struct Load {
    int column_px = 0, row_px = 0;
  };

  void add_half(const std::int16_t* places, int first_px, int row_px, int half);

  int width_px_, height_px_;
  std::vector<Load> loads_, more_;
  std::ptrdiff_t stride_ = 0;  ///< that the offsets are for
  Tables tables_;
};

}  // namespace understory
