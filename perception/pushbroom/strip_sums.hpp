#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "perception/gray_view.hpp"
#include "perception/pushbroom/block_rule.hpp"

/// The detector's inner loops in portable SIMD (Highway, dispatched at run time): everything that is computed
/// for every pixel of a strip of block rows. All of it is exact: results equal block_rule.hpp's arithmetic
/// bit for bit on every instruction set, except that candidates are a superset, still to be tested exactly.
namespace understory {

/// Loads run up to this far past a row's last column, and one column before its first.
inline constexpr int over_read_px = 128;
/// The rows v - 1 .. v + 5 around a strip whose blocks begin at row v.
inline constexpr int strip_row_count = 7;

/// Row pointers of one strip of one image, mirrored at the image's top and bottom (row -1 is row 1), each
/// readable from column -1 to width + over_read_px.
struct StripRows {
  const std::uint8_t* row[strip_row_count] = {};
};

/// Gives a strip's rows, out of the image itself where loads stay inside it, else out of a padded copy.
class StripReader {
 public:
  StripRows rows(const GrayView& image, int row_px);

 private:
  std::vector<std::uint8_t> copy_;
};

/// Rows of bytes that vectors may overshoot: an image's edge map, or a few rows of one.
class EdgeMap {
 public:
  EdgeMap() = default;
  EdgeMap(int width_px, int height_px)
      : width_px_(width_px),
        height_px_(height_px),
        stride_(whole_lines(width_px + over_read_px)),
        bytes_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_px)) {}
  std::uint8_t* row(int row_px) { return bytes_.data() + row_px * stride(); }
  std::ptrdiff_t stride() const { return stride_; }
  GrayView view() const { return {bytes_.data(), stride(), width_px_, height_px_}; }

 private:
  int width_px_ = 0, height_px_ = 0, stride_ = 0;
  AlignedVector<std::uint8_t> bytes_;
};

/// Edge sums of every 5x5 block of a strip: sums[u] = sum of the edge map over (u .. u + 4, v .. v + 4), for
/// the columns first_px <= u <= last_px - 5 (others up to over_read_px beyond are undefined). `width_px` is
/// the image's, whose outermost columns mirror. If `edges` is given, the strip's rows of the edge map are
/// written there, from row_px on, columns first_px .. last_px - 1.
void strip_edge_sums(const StripRows& rows, int first_px, int last_px, int width_px,
                     std::vector<std::uint16_t>& column_scratch, std::uint16_t* sums, EdgeMap* edges,
                     int row_px);

/// One row of the edge map, columns first_px .. last_px - 1, from the rows above, here and below.
void edge_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int first_px,
              int last_px, int width_px, std::uint8_t* edges);

/// The edge at an outermost column, which has both corners of a side on the column next to it.
inline std::uint8_t outermost_edge(const std::uint8_t* above, const std::uint8_t* here,
                                   const std::uint8_t* below, int column_px, int width_px) {
  const int inner_px = column_px == 0 ? 1 : width_px - 2;
  return static_cast<std::uint8_t>(
      std::clamp(4 * (above[inner_px] + below[inner_px]) - 8 * here[column_px], 0, 255));
}

/// The test that a candidate must pass. limit_share is the score limit in 1/16384, rounded up; any_score lets
/// every score pass (limits too large for 16 bits).
struct CandidateTest {
  int minimum_edge_sum = 0;
  std::uint16_t limit_share = 0;
  bool any_score = false;
};
CandidateTest candidate_test(int minimum_edge_sum, std::int64_t limit_units);

/// Compares the left strip from column left_px with the right one from column right_px, over `count` columns.
/// column_sads[x] is the SAD of column x over the five rows, at most 255; sads[x] the sum of the five columns
/// from x on, which is exact unless one of them is 255; then it may be too small.
void strip_sads(const StripRows& left, int left_px, const StripRows& right, int right_px, int count,
                std::uint8_t* column_sads, std::uint16_t* sads);

/// Sets bit x of `candidates` where block x may pass `test`: both edge sums do, and the score does or nearly
/// does. Bits from `count` - 4 on are undefined.
void find_candidates(const std::uint16_t* sads, const std::uint16_t* left_sums,
                     const std::uint16_t* right_sums, int count, const CandidateTest& test,
                     std::uint64_t* candidates);

}  // namespace understory
