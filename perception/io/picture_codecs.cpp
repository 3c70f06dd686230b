#include "perception/io/picture_codecs.hpp"

#include <opencv2/imgcodecs.hpp>

namespace understory {
namespace {

cv::Mat decode(const std::string& bytes) {
  if (bytes.empty()) return {};
  const cv::Mat row(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
  return cv::imdecode(row, cv::IMREAD_UNCHANGED);
}

std::vector<unsigned char> encode_jpeg(const cv::Mat& picture, int quality) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return bytes;
}

std::unique_ptr<cv::VideoCapture> read_film(const std::string& file) {
  return std::make_unique<cv::VideoCapture>(file, cv::CAP_FFMPEG);
}

std::unique_ptr<cv::VideoWriter> write_film(const std::string& file, double frames_per_s, cv::Size size) {
  const int h264 = cv::VideoWriter::fourcc('a', 'v', 'c', '1');
  return std::make_unique<cv::VideoWriter>(file, cv::CAP_FFMPEG, h264, frames_per_s, size);
}

}  // namespace

const PictureCodecs& picture_codecs() {
  static constexpr PictureCodecs codecs{decode, encode_jpeg, read_film, write_film};
  return codecs;
}

}  // namespace understory
