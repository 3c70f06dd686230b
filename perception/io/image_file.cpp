#include "perception/io/image_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <string>

#include "perception/io/picture_codecs.hpp"
#include "perception/io/text_table.hpp"

namespace understory {
namespace {

std::string kind_of(const cv::Mat& image) {
  const std::string depth =
      image.depth() == CV_8U ? "8-bit" : (image.depth() == CV_16U ? "16-bit" : "floating point");
  return depth + (image.channels() == 1 ? " gray" : " colour");
}

}  // namespace

bool is_image_name(const std::filesystem::path& file) {
  constexpr std::array<const char*, 7> endings{".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

cv::Mat read_gray_image(const std::filesystem::path& file) {
  const std::string bytes = text_of(file);
  const auto expected = [&](const std::string& found) {
    return std::runtime_error(file.string() + ": expected an 8-bit gray image, found " + found);
  };
  if (bytes.empty()) throw expected("an empty file");
  cv::Mat image;
  try {
    image = picture_codecs().decode(bytes);
  } catch (const cv::Exception&) {
    throw expected("what OpenCV cannot decode");
  }
  if (image.empty()) throw expected("no image, or a damaged one");
  if (image.type() != CV_8UC1) throw expected(kind_of(image));
  return image;
}

}  // namespace understory
