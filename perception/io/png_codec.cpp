#include "perception/io/png_codec.hpp"

#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <cstring>
#include <stdexcept>

namespace understory {
namespace {

struct ReadStruct {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  ~ReadStruct() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct WriteStruct {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  ~WriteStruct() { png_destroy_write_struct(&png, &info); }
};

/// A damaged file is an empty image; libpng prints nothing.
[[noreturn]] void leave(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void say_nothing(png_structp, png_const_charp) {}

void take_bytes(png_structp png, png_bytep to, std::size_t count) {
  std::string_view& left = *static_cast<std::string_view*>(png_get_io_ptr(png));
  if (count > left.size()) png_error(png, "cut short");
  std::memcpy(to, left.data(), count);
  left.remove_prefix(count);
}

void add_bytes(png_structp png, png_bytep from, std::size_t count) {
  auto& bytes = *static_cast<std::vector<unsigned char>*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), from, from + count);
}

std::vector<png_bytep> rows_of(cv::Mat image) {
  std::vector<png_bytep> rows;
  for (int row = 0; row < image.rows; ++row) rows.push_back(image.ptr(row));
  return rows;
}

// libpng leaves a function of ours by a jump where it fails: the functions that it may leave hold nothing
// that has a destructor.

bool read_header(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_info(png, info);
  return true;
}

bool read_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_bgr(png);
  png_set_swap(png);  // PNG's numbers begin with the high byte
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

bool write_file(png_structp png, png_infop info, const cv::Mat& image, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, Z_BEST_SPEED);
  png_set_compression_strategy(png, Z_RLE);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.cols), static_cast<png_uint_32>(image.rows),
               image.depth() == CV_16U ? 16 : 8,
               image.channels() == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_set_bgr(png);
  png_set_swap(png);
  png_write_image(png, rows);
  png_write_end(png, info);
  return true;
}

/// The type of cv::Mat for it; -1 for the kinds that are left to OpenCV.
int type_of(png_structp png, png_infop info) {
  if (png_get_interlace_type(png, info) != PNG_INTERLACE_NONE || png_get_valid(png, info, PNG_INFO_tRNS) != 0)
    return -1;
  const int color = png_get_color_type(png, info), bits = png_get_bit_depth(png, info);
  if (color == PNG_COLOR_TYPE_GRAY && bits == 8) return CV_8UC1;
  if (color == PNG_COLOR_TYPE_GRAY && bits == 16) return CV_16UC1;
  return color == PNG_COLOR_TYPE_RGB && bits == 8 ? CV_8UC3 : -1;
}

}  // namespace

cv::Mat decode_png(std::string_view bytes) {
  const ReadStruct file;
  if (file.info == nullptr) return {};
  png_set_error_fn(file.png, nullptr, leave, say_nothing);
  png_set_read_fn(file.png, &bytes, take_bytes);
  if (!read_header(file.png, file.info)) return {};
  const int type = type_of(file.png, file.info);
  if (type < 0) return {};
  cv::Mat image(static_cast<int>(png_get_image_height(file.png, file.info)),
                static_cast<int>(png_get_image_width(file.png, file.info)), type);
  std::vector<png_bytep> rows = rows_of(image);
  return read_rows(file.png, rows.data()) ? image : cv::Mat();
}

std::vector<unsigned char> encode_png(const cv::Mat& image) {
  if (image.empty() || (image.type() != CV_8UC1 && image.type() != CV_16UC1 && image.type() != CV_8UC3))
    throw std::invalid_argument("a PNG is made of an 8- or 16-bit gray or an 8-bit BGR image");
  const WriteStruct file;
  std::vector<unsigned char> bytes;
  std::vector<png_bytep> rows = rows_of(image);
  if (file.info != nullptr) {
    png_set_error_fn(file.png, nullptr, leave, say_nothing);
    png_set_write_fn(file.png, &bytes, add_bytes, nullptr);
  }
  if (file.info == nullptr || !write_file(file.png, file.info, image, rows.data()))
    throw std::runtime_error("libpng cannot write this image");
  return bytes;
}

}  // namespace understory
