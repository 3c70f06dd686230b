#include "perception/io/png_codec.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>

namespace understory {
namespace {

constexpr int kinds[] = {CV_8UC1, CV_16UC1, CV_8UC3};

/// Half of it noise, half of it a ramp.
cv::Mat some_image(int type, int width_px = 37, int height_px = 23) {
  cv::Mat image(height_px, width_px, type);
  std::mt19937 generator(7);
  for (int row = 0; row < height_px; ++row)
    for (std::size_t i = 0; i < width_px * image.elemSize(); ++i)
      image.ptr(row)[i] = static_cast<unsigned char>(row % 2 == 0 ? generator() : i);
  return image;
}

std::vector<unsigned char> packed_by_opencv(const cv::Mat& image, const std::vector<int>& parameters = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes, parameters);
  return bytes;
}

std::string_view text_of(const std::vector<unsigned char>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool are_equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(PngCodec, PacksAsOpenCvDoes) {
  for (const int type : kinds) {
    EXPECT_EQ(encode_png(some_image(type)), packed_by_opencv(some_image(type)));
    const cv::Mat part = some_image(type)(cv::Rect(3, 2, 11, 9));  // rows that do not follow each other
    EXPECT_EQ(encode_png(part), packed_by_opencv(part));
  }
}

TEST(PngCodec, ReadsAsOpenCvDoes) {
  for (const int type : kinds)
    for (const int level : {0, 1, 9}) {
      const auto bytes = packed_by_opencv(some_image(type), {cv::IMWRITE_PNG_COMPRESSION, level});
      EXPECT_TRUE(are_equal(decode_png(text_of(bytes)), some_image(type)));
    }
  const cv::Mat large = some_image(CV_8UC1, 1500, 1100);  // many chunks
  EXPECT_TRUE(are_equal(decode_png(text_of(packed_by_opencv(large))), large));
}

TEST(PngCodec, LeavesOtherKindsToOpenCv) {
  for (const int type : {CV_8UC4, CV_16UC3, CV_16UC4})
    EXPECT_TRUE(decode_png(text_of(packed_by_opencv(some_image(type)))).empty());
  const auto bits = packed_by_opencv(some_image(CV_8UC1), {cv::IMWRITE_PNG_BILEVEL, 1});
  EXPECT_TRUE(decode_png(text_of(bits)).empty());
  EXPECT_THROW(encode_png(some_image(CV_8UC4)), std::invalid_argument);
  EXPECT_THROW(encode_png(cv::Mat()), std::invalid_argument);
}

TEST(PngCodec, FindsEveryCutAndAlmostEveryChangedByte) {
  const cv::Mat image = some_image(CV_16UC1);
  const std::vector<unsigned char> whole = packed_by_opencv(image);
  testing::internal::CaptureStderr();
  for (std::size_t length = 0; length < whole.size(); ++length)
    ASSERT_TRUE(decode_png(text_of(whole).substr(0, length)).empty()) << length;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<unsigned char> changed = whole;
    changed[i] ^= 1;
    const cv::Mat found = decode_png(text_of(changed));
    ASSERT_TRUE(found.empty() || are_equal(found, image)) << i;  // each chunk has a checksum
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace understory
