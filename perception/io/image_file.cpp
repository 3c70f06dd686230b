#include "perception/io/image_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <string>
#include <string_view>

#include "perception/io/picture_codecs.hpp"
#include "perception/io/text_table.hpp"

namespace understory {
namespace {

std::string kind_of(const cv::Mat& image) {
  const std::string depth =
      image.depth() == CV_8U ? "8-bit" : (image.depth() == CV_16U ? "16-bit" : "floating point");
  return depth + (image.channels() == 1 ? " gray" : " colour");
}

/// Whether the file is of a format that is_image_name names, told as OpenCV tells them. What is of none it
/// would offer to other libraries too, DICOM's among them, which a few bytes bring to abort or to ask for
/// gigabytes (found by fuzzing).
bool begins_as_image(std::string_view bytes) {
  using namespace std::string_view_literals;
  constexpr std::array beginnings{"\x89PNG\r\n\x1a\n"sv, "\xFF\xD8\xFF"sv, "BM"sv, "II*\0"sv, "MM\0*"sv};
  const bool is_pgm_or_kin = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
                             std::isspace(static_cast<unsigned char>(bytes[2])) != 0;
  return is_pgm_or_kin || std::any_of(beginnings.begin(), beginnings.end(), [&](std::string_view beginning) {
           return bytes.starts_with(beginning);
         });
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
  if (!begins_as_image(bytes)) throw expected("no image, or a damaged one");
  cv::Mat image;
  try {
    image = picture_codecs().decode(bytes);
  } catch (const std::exception&) {  // not all its libraries throw cv::Exception
    throw expected("what OpenCV cannot decode");
  }
  if (image.empty()) throw expected("no image, or a damaged one");
  if (image.type() != CV_8UC1) throw expected(kind_of(image));
  return image;
}

}  // namespace understory
