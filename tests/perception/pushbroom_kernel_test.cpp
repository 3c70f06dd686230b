// The fast kernel against the plain one, bit for bit, on every instruction set of this machine: real kinds of
// texture, flat, striped and saturated images, odd and tiny sizes, and rules drawn at random.
#include "perception/pushbroom/pushbroom_kernel.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <random>

#include "perception/io/png_codec.hpp"
#include "perception/io/text_file.hpp"
#include "perception/pushbroom/block_rule.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/plain_pushbroom.hpp"
#include "tests/support/shared_data.hpp"

namespace understory {

bool operator==(const BlockMatch& a, const BlockMatch& b) {
  return a.column_px == b.column_px && a.row_px == b.row_px && a.disparity == b.disparity && a.sad == b.sad &&
         a.left_edge_sum == b.left_edge_sum && a.right_edge_sum == b.right_edge_sum &&
         a.sad_below == b.sad_below && a.sad_above == b.sad_above;
}
void PrintTo(const BlockMatch& match, std::ostream* out) {
  *out << "(" << match.column_px << ", " << match.row_px << ", #" << match.disparity << ", sad " << match.sad
       << ", beside it " << match.sad_below << " " << match.sad_above << ", edges " << match.left_edge_sum
       << " " << match.right_edge_sum << ")";
}

namespace {

enum class Texture { noise, saturated, flat, stripes, smooth, sparse };

/// A pair whose right image is the left one moved by `disparity_px` in one half and by nothing in the other,
/// with a little noise, so that every branch is taken. Memory ends with the last pixel.
struct Pair {
  int width_px, height_px;
  std::vector<std::uint8_t> left, right;
  GrayView left_view() const { return {left.data(), width_px, width_px, height_px}; }
  GrayView right_view() const { return {right.data(), width_px, width_px, height_px}; }
};

std::uint8_t pixel(Texture texture, int u, int v, std::mt19937_64& generator) {
  const auto random = static_cast<int>(generator() >> 56);
  switch (texture) {
    case Texture::noise:
      return static_cast<std::uint8_t>(random);
    case Texture::saturated:
      return random % 2 != 0 ? 255 : 0;
    case Texture::flat:
      return 131;
    case Texture::stripes:
      return static_cast<std::uint8_t>((u / 3 % 4) * 60 + random % 16);
    case Texture::smooth:
      return static_cast<std::uint8_t>(128 + 90 * std::sin(0.9 * u + 0.31 * v * (u % 7)) + random % 8);
    case Texture::sparse:
      return random < 8 ? 255 : 20;
  }
  return 0;
}

Pair pair_of(int width_px, int height_px, Texture texture, int disparity_px, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Pair pair{width_px, height_px, {}, {}};
  const auto count = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  pair.left.resize(count);
  pair.right.resize(count);
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u)
      pair.left[static_cast<std::size_t>(v * width_px + u)] = pixel(texture, u, v, generator);
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u) {
      const int from = std::clamp(u + (v / 20 % 2 == 0 ? disparity_px : 0), 0, width_px - 1);
      const int value =
          pair.left[static_cast<std::size_t>(v * width_px + from)] + static_cast<int>(generator() % 9) - 4;
      pair.right[static_cast<std::size_t>(v * width_px + u)] =
          static_cast<std::uint8_t>(std::clamp(value, 0, 255));
    }
  return pair;
}

BlockRule pushbroom_of(int width_px, int height_px, std::vector<int> disparities) {
  BlockRule rule;
  rule.width_px = width_px;
  rule.height_px = height_px;
  rule.last_row_px = height_px;
  for (const int d : disparities) rule.disparities.push_back({d, 215, score_limit_units(0.25)});
  rule.infinity_px = disparities.front() / 2;
  rule.window.limit_units = score_limit_units(0.324);
  rule.minimum_disparity_px = rule.infinity_px;
  rule.maximum_disparity_px = disparities.front() + 20;
  return rule;
}

/// Over every instruction set there is; `bands` threads' worth of kernels. Returns the number of matches.
std::size_t expect_equal(const BlockRule& rule, const Pair& pair, int bands = 1) {
  const std::vector<BlockMatch> expected = support::plain_matches(rule, pair.left_view(), pair.right_view());
  support::on_every_instruction_set([&](const std::string& name) {
    PushbroomKernel kernel(rule);
    std::vector<BlockMatch> found;
    for (int band = 0; band < bands; ++band) {
      const auto& matches =
          kernel.search(pair.left_view(), pair.right_view(), kernel.strip_count() * band / bands,
                        kernel.strip_count() * (band + 1) / bands);
      found.insert(found.end(), matches.begin(), matches.end());
    }
    EXPECT_EQ(found, expected) << name;
  });
  return expected.size();
}

TEST(PushbroomKernel, EqualsThePlainRuleOnEveryTextureAndInstructionSet) {
  std::size_t with_invariance = 0, with_uniqueness = 0, bare = 0;
  for (const Texture texture : {Texture::noise, Texture::saturated, Texture::flat, Texture::stripes,
                                Texture::smooth, Texture::sparse}) {
    const Pair pair = pair_of(376, 240, texture, 33, 7);
    BlockRule rule = pushbroom_of(376, 240, {33});
    bare += expect_equal(rule, pair);
    rule.horizontal_invariance = true;
    with_invariance += expect_equal(rule, pair);
    rule.horizontal_invariance = false;
    rule.uniqueness = true;
    with_uniqueness += expect_equal(rule, pair);
  }
  EXPECT_GT(bare, 1000u);
  EXPECT_GT(with_invariance, 100u);
  EXPECT_LT(with_invariance, bare);
  EXPECT_GT(with_uniqueness, 100u);
  EXPECT_LT(with_uniqueness, bare);
}

// Called so that it stays out of the thread sanitizer's tests, as all that read image files.
TEST(Recordings, GiveTheKernelTheMatchesOfThePlainRule) {
  const std::string name = "stereo/euroc-v1_01";
  const auto path = support::shared_data(name);
  if (!path) GTEST_SKIP() << support::missing_data(name);
  std::size_t pairs = 0, found = 0;
  for (const auto& file : std::filesystem::directory_iterator(*path / "mav0/cam0/data")) {
    const cv::Mat left = decode_png(read_file(file.path()));
    const cv::Mat right = decode_png(read_file(*path / "mav0/cam1/data" / file.path().filename()));
    const int width = left.cols, height = left.rows;
    const Pair pair{width, height, {left.datastart, left.dataend}, {right.datastart, right.dataend}};
    ++pairs;
    for (const int variant : {0, 1}) {
      BlockRule rule = pushbroom_of(width, height, {22, 16});
      rule.horizontal_invariance = variant == 0;
      rule.uniqueness = variant == 1;
      found += expect_equal(rule, pair, 2);
    }
  }
  EXPECT_EQ(pairs, 4u);
  EXPECT_GT(found, 500u);
}

TEST(PushbroomKernel, EqualsThePlainRuleWithSeveralDisparitiesAndBands) {
  const Pair pair = pair_of(376, 240, Texture::noise, 33, 8);
  BlockRule rule = pushbroom_of(376, 240, {33, 28, 0, -17, 46});
  rule.horizontal_invariance = true;
  for (const int bands : {1, 2, 3, 50}) EXPECT_GT(expect_equal(rule, pair, bands), 100u);
}

TEST(PushbroomKernel, EqualsThePlainRuleOnOddAndTinyImages) {
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {5, 5}, {6, 5}, {7, 9}, {13, 6}, {33, 7}, {64, 11}, {65, 12}, {127, 17}, {129, 33}, {301, 64}}) {
    for (const int disparity : {0, 1, width - 5, -(width - 5), width / 3}) {
      if (std::abs(disparity) + block_px > width) continue;
      const Pair pair = pair_of(width, height, Texture::noise, disparity, 9);
      for (const int filters : {0, 1, 2, 3}) {
        BlockRule rule = pushbroom_of(width, height, {disparity});
        rule.horizontal_invariance = (filters & 1) != 0;
        rule.uniqueness = (filters & 2) != 0;
        rule.window.rows_each_side_px = 2;
        expect_equal(rule, pair);
      }
    }
  }
}

TEST(PushbroomKernel, EqualsThePlainRuleForRulesDrawnAtRandom) {
  const bool holds = rc::check([] {
    const int width = *rc::gen::inRange(8, 200), height = *rc::gen::inRange(5, 60);
    const auto texture = static_cast<Texture>(*rc::gen::inRange(0, 6));
    const int disparity = *rc::gen::inRange(-(width - 5), width - 4);
    const Pair pair = pair_of(width, height, texture, disparity, *rc::gen::inRange<std::uint64_t>(1, 1000));
    BlockRule rule = pushbroom_of(width, height, {disparity});
    if (*rc::gen::arbitrary<bool>())
      rule.disparities.push_back({*rc::gen::inRange(-(width - 5), width - 4), 0, score_limit_units(10)});
    int largest_px = 0;
    for (const DisparityRule& one : rule.disparities)
      largest_px = std::max(largest_px, std::abs(one.disparity_px));
    rule.stride_px = *rc::gen::inRange(1, 9);
    rule.right_margin_px = *rc::gen::inRange(0, width - block_px - std::abs(largest_px) + 1);
    rule.last_row_px = *rc::gen::inRange(0, 60);
    rule.disparities.front().minimum_edge_sum = *rc::gen::inRange(0, largest_edge_sum + 1);
    rule.disparities.front().limit_units = *rc::gen::inRange<std::int64_t>(0, 10 * score_unit);
    rule.horizontal_invariance = *rc::gen::arbitrary<bool>();
    rule.uniqueness = *rc::gen::arbitrary<bool>();
    rule.neighbours = *rc::gen::arbitrary<bool>();
    rule.infinity_px = *rc::gen::inRange(-width, width);
    rule.minimum_disparity_px = *rc::gen::inRange(-width, width);
    rule.maximum_disparity_px = *rc::gen::inRange(rule.minimum_disparity_px, 2 * width);
    rule.uniqueness_ratio = *rc::gen::inRange(1000, 100000) / 1000.0;
    rule.window.columns_each_side_px = *rc::gen::inRange(0, 12);
    rule.window.rows_each_side_px = *rc::gen::inRange(0, 10);
    rule.window.row_step_px = *rc::gen::inRange(1, 6);
    rule.window.minimum_edge_sum = *rc::gen::inRange(0, 3000);
    rule.window.limit_units = *rc::gen::inRange<std::int64_t>(0, score_unit);
    expect_equal(rule, pair, *rc::gen::inRange(1, 4));
    RC_ASSERT(!testing::Test::HasFailure());
  });
  EXPECT_TRUE(holds);
}

TEST(PushbroomKernel, RefusesRulesThatCannotBeMeant) {
  BlockRule rule = pushbroom_of(100, 50, {10});
  EXPECT_NO_THROW(PushbroomKernel{rule});
  rule.disparities.front().disparity_px = 96;
  EXPECT_THROW(PushbroomKernel{rule}, std::logic_error);
  rule = pushbroom_of(100, 4, {10});
  EXPECT_THROW(PushbroomKernel{rule}, std::logic_error);
  rule = pushbroom_of(100, 50, {10});
  rule.right_margin_px = 86;
  EXPECT_THROW(PushbroomKernel{rule}, std::logic_error);
  rule = pushbroom_of(100, 50, {10});
  rule.stride_px = 0;
  EXPECT_THROW(PushbroomKernel{rule}, std::logic_error);
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
      expect_edges_of_opencv(support::noise(cols, rows, seed, false));
      expect_edges_of_opencv(support::noise(cols, rows, seed, true));
    }
    expect_edges_of_opencv(cv::Mat(rows, cols, CV_8UC1, cv::Scalar(77)));
    expect_edges_of_opencv(cv::Mat(rows, cols, CV_8UC1, cv::Scalar(255)));
  }
}

TEST(EdgeMap, ReadsImagesWithPaddedRows) {
  const cv::Mat whole = support::noise(80, 60, 5);
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
    const cv::Mat left = support::noise(50, 40, 11, saturated), right = support::noise(50, 40, 12, saturated);
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
