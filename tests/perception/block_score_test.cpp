#include "perception/pushbroom/block_score.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "tests/support/plain_pushbroom.hpp"

namespace understory {
namespace {

cv::Mat random_image(int rows, int cols, std::uint64_t seed, bool saturated) {
  std::mt19937_64 generator(seed);
  cv::Mat image(rows, cols, CV_8UC1);
  for (auto it = image.begin<std::uint8_t>(); it != image.end<std::uint8_t>(); ++it) {
    const auto bits = static_cast<std::uint8_t>(generator() >> 56);
    *it = saturated ? (bits & 1 ? 255 : 0) : bits;
  }
  return image;
}

GrayView view(const cv::Mat& image) {
  return {image.data, static_cast<std::ptrdiff_t>(image.step[0]), image.cols, image.rows};
}

void expect_edges_of_opencv(const cv::Mat& image) {
  cv::Mat expected;
  cv::Laplacian(image, expected, CV_8U, 3);
  std::vector<std::uint8_t> edges;
  support::edge_map(view(image), edges);
  const cv::Mat found(image.rows, image.cols, CV_8UC1, edges.data());
  EXPECT_EQ(cv::countNonZero(found != expected), 0) << image.cols << "x" << image.rows;
}

TEST(EdgeMap, EqualsOpenCvsLaplacianBitForBit) {
  for (const auto& [rows, cols] :
       std::vector<std::pair<int, int>>{{240, 376}, {2, 2}, {7, 3}, {5, 33}, {31, 2}}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      expect_edges_of_opencv(random_image(rows, cols, seed, false));
      expect_edges_of_opencv(random_image(rows, cols, seed, true));
    }
    expect_edges_of_opencv(cv::Mat(rows, cols, CV_8UC1, cv::Scalar(77)));
    expect_edges_of_opencv(cv::Mat(rows, cols, CV_8UC1, cv::Scalar(255)));
  }
}

TEST(EdgeMap, ReadsImagesWithPaddedRows) {
  const cv::Mat whole = random_image(60, 80, 5, false);
  const cv::Mat part = whole(cv::Rect(7, 9, 50, 40)).clone();
  cv::Mat padded = whole.clone();
  part.copyTo(padded(cv::Rect(0, 0, 50, 40)));
  std::vector<std::uint8_t> from_padded, from_packed;
  support::edge_map(view(padded(cv::Rect(0, 0, 50, 40))), from_padded);
  support::edge_map(view(part), from_packed);
  EXPECT_EQ(from_padded, from_packed);
}

TEST(Block, SumsAndDifferencesEqualOpenCvs) {
  for (const bool saturated : {false, true}) {
    const cv::Mat left = random_image(40, 50, 11, saturated), right = random_image(40, 50, 12, saturated);
    for (int v = 0; v + block_px <= left.rows; v += 3) {
      for (int u = 0; u + block_px <= left.cols; ++u) {
        const cv::Rect block(u, v, block_px, block_px);
        EXPECT_EQ(block_sum(left.ptr(v) + u, 50), static_cast<int>(cv::sum(left(block))[0]));
        EXPECT_EQ(block_sad(left.ptr(v) + u, 50, right.ptr(v) + u, 50),
                  static_cast<int>(cv::norm(left(block), right(block), cv::NORM_L1)));
      }
    }
  }
}

TEST(Score, IsTheOriginalsIntegerTestAtEveryEdgeSum) {
  const std::int64_t limit = score_limit_units(54.0 / 333.0), twice = score_limit_units(108.0 / 333.0);
  for (int edge_sum = 0; edge_sum <= 2 * largest_edge_sum; edge_sum += 37) {
    for (const int offset : {-1, 0, 1}) {
      const int sad = std::max(0, 54 * edge_sum / 333 + offset);
      EXPECT_EQ(scores_below(sad, edge_sum, limit), 333 * sad < 54 * edge_sum);
      EXPECT_EQ(scores_below(2 * sad, edge_sum, twice), 333 * 2 * sad < 108 * edge_sum);
    }
  }
}

}  // namespace
}  // namespace understory
