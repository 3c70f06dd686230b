#include "perception/io/image_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <opencv2/imgproc.hpp>
#include <string>
#include <string_view>

#include "perception/io/machine_limits.hpp"
#include "perception/io/picture_codecs.hpp"
#include "perception/io/png_codec.hpp"
#include "perception/io/text_file.hpp"

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

/// What cannot be decoded for want of memory or descriptors is no damaged file.
void require_resources(const std::filesystem::path& file) {
  const std::string lacking = lacking_resource();
  if (!lacking.empty()) throw MachineError(file.string() + ": " + lacking);
}

struct ClaimedSize {
  std::uint32_t width_px = 0, height_px = 0;
};

/// `count` bytes as a whole number; 0 past the end.
std::uint32_t whole_at(std::string_view bytes, std::size_t at, std::size_t count, bool big_end_first) {
  if (at > bytes.size() || bytes.size() - at < count) return 0;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value = value << 8U | static_cast<unsigned char>(bytes[at + (big_end_first ? i : count - 1 - i)]);
  return value;
}

/// From the start-of-frame segment.
ClaimedSize size_of_jpeg(std::string_view bytes) {
  for (std::size_t at = 2; at + 9 < bytes.size(); at += 2 + whole_at(bytes, at + 2, 2, true)) {
    const std::uint32_t marker = whole_at(bytes, at + 1, 1, true);
    const bool is_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) return {whole_at(bytes, at + 7, 2, true), whole_at(bytes, at + 5, 2, true)};
  }
  return {};
}

/// From the first directory's tags 256 and 257.
ClaimedSize size_of_tiff(std::string_view bytes) {
  const bool big_end_first = bytes[0] == 'M';
  const auto whole = [&](std::size_t at, std::size_t count) {
    return whole_at(bytes, at, count, big_end_first);
  };
  ClaimedSize size;
  const std::size_t directory = whole(4, 4);
  for (std::size_t at = directory + 2; at < directory + 2 + 12 * whole(directory, 2); at += 12) {
    const std::uint32_t value = whole(at + 8, whole(at + 2, 2) == 3 ? 2 : 4);
    if (whole(at, 2) == 256) size.width_px = value;
    if (whole(at, 2) == 257) size.height_px = value;
  }
  return size;
}

/// What the header says, 0 where it says nothing: a file of some kilobytes can hold an image of gigabytes.
ClaimedSize claimed_size(const std::string& bytes) {
  if (bytes[0] == '\x89') return {whole_at(bytes, 16, 4, true), whole_at(bytes, 20, 4, true)};
  if (bytes[0] == '\xFF') return size_of_jpeg(bytes);
  if (bytes[0] == 'I' || bytes[0] == 'M') return size_of_tiff(bytes);
  ClaimedSize size;
  if (bytes[0] == 'P') {
    std::sscanf(bytes.c_str() + 2, " %9u %9u", &size.width_px, &size.height_px);
    return size;
  }
  const std::uint32_t height_px = whole_at(bytes, 22, 4, false);  // negative: rows from the top
  return {whole_at(bytes, 18, 4, false), std::min(height_px, 0 - height_px)};
}

bool ends_as_one_of(const std::filesystem::path& file, std::initializer_list<std::string_view> endings) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

/// A PNG without its texts and colour profiles, which may unpack to gigabytes in any decoder.
std::string without_texts(const std::string& png) {
  constexpr std::size_t signature = 8, around_data = 12;  // length, kind and check sum
  std::string kept = png.substr(0, signature);
  for (std::size_t at = signature; at < png.size();) {
    const std::size_t length = around_data + whole_at(png, at, 4, true);
    const std::string_view chunk = std::string_view(png).substr(at, length);
    const std::string_view kind = chunk.substr(std::min<std::size_t>(4, chunk.size()), 4);
    if (kind != "tEXt" && kind != "zTXt" && kind != "iTXt" && kind != "iCCP") kept += chunk;
    at += chunk.size();
  }
  return kept;
}

}  // namespace

bool is_image_name(const std::filesystem::path& file) {
  return ends_as_one_of(file, {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm"});
}

bool is_video_name(const std::filesystem::path& file) {
  return ends_as_one_of(file, {".mp4", ".m4v", ".mov", ".mkv", ".avi", ".webm", ".mpg", ".mpeg", ".ogv"});
}

namespace {

std::string unexpected(const std::filesystem::path& file, const std::string& kind, const std::string& found) {
  return file.string() + ": expected " + kind + ", found " + found;
}

/// As it is stored.
cv::Mat read_image(const std::filesystem::path& file, const std::string& kind) {
  const auto expected = [&](const std::string& found) { return InputError(unexpected(file, kind, found)); };
  std::string bytes = read_file(file, maximum_image_bytes);
  if (bytes.empty()) throw expected("an empty file");
  if (!begins_as_image(bytes)) throw expected("no image, or a damaged one");
  if (bytes[0] == '\x89') bytes = without_texts(bytes);
  const ClaimedSize size = claimed_size(bytes);
  if (std::max(size.width_px, size.height_px) > maximum_side_px)
    throw expected(std::to_string(size.width_px) + "x" + std::to_string(size.height_px) +
                   " px: at most 8192x8192 are read");
  cv::Mat image;
  try {
    image = decode_png(bytes);
    if (image.empty()) image = picture_codecs().decode(bytes);
  } catch (const MachineError&) {
    throw;
  } catch (const std::exception&) {  // not all its libraries throw cv::Exception
    require_resources(file);
    throw expected("what OpenCV cannot decode");
  }
  if (image.empty()) require_resources(file);
  if (image.empty()) throw expected("no image, or a damaged one");
  return image;
}

}  // namespace

cv::Mat read_gray_image(const std::filesystem::path& file, int depth) {
  const std::string kind = depth == CV_8U ? "an 8-bit gray image" : "a 16-bit gray image";
  const cv::Mat image = read_image(file, kind);
  if (image.type() != CV_MAKETYPE(depth, 1)) throw InputError(unexpected(file, kind, kind_of(image)));
  return image;
}

cv::Mat read_gray_image_of_8_or_16_bits(const std::filesystem::path& file, int& depth) {
  constexpr double fewest_of_16_bits = 4096;
  const std::string kind = depth == CV_8U    ? "an 8-bit gray image"
                           : depth == CV_16U ? "a 16-bit gray image as before"
                                             : "a gray image of 8 or 16 bits";
  const cv::Mat image = read_image(file, kind);
  if (image.channels() != 1 || (image.depth() != CV_8U && image.depth() != CV_16U) ||
      (depth >= 0 && image.depth() != depth))
    throw InputError(unexpected(file, kind, kind_of(image)));
  depth = image.depth();
  if (depth == CV_8U) return image;
  double greatest = 0;
  cv::minMaxLoc(image, nullptr, &greatest);
  if (greatest < fewest_of_16_bits)
    throw InputError(unexpected(
        file, kind,
        "16-bit numbers up to " + std::to_string(std::lround(greatest)) + ", whose scale is not known"));
  cv::Mat eight_bits;
  image.convertTo(eight_bits, CV_8U, 1 / 257.0);
  return eight_bits;
}

cv::Mat read_image_as_gray(const std::filesystem::path& file) {
  const cv::Mat image = read_image(file, "an 8-bit image");
  if (image.type() == CV_8UC1) return image;
  cv::Mat gray;
  if (image.type() != CV_8UC3 && image.type() != CV_8UC4)
    throw InputError(unexpected(file, "an 8-bit image", kind_of(image)));
  cv::cvtColor(image, gray, image.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
  return gray;
}

}  // namespace understory
