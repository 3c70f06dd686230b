#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace understory {

/// The two image files of one moment.
struct StereoFiles {
  std::int64_t t_ns = 0;
  std::filesystem::path left;
  std::filesystem::path right;
};

/// Stereo pairs in image files, in the order they were taken. Every file named exists; none is read yet.
struct ImageSequence {
  std::vector<StereoFiles> pairs;
  bool timed = false;         ///< t_ns is the recorder's clock and increases strictly; otherwise all are 0
  std::int64_t unpaired = 0;  ///< images left out, since the other camera took none at their moment
};

/// The pairs of a EuRoC/ASL data set: images that both cameras' data.csv list at the same nanosecond. Throws
/// std::runtime_error, one line, at a broken or missing list, a listed image that is not there, or no pair.
ImageSequence euroc_sequence(const std::filesystem::path& folder);

/// The pairs of two folders of images. Sorted by name, numbers within names by value, the n-th left belongs
/// to the n-th right; to be sure that none is missing, the names (without ending) must be equal, or else be
/// numbered alike (left_07, right_07), or each be numbered without a gap and with no number in common
/// (0 .. 9, 10 .. 19). Names that are times, as data sets write them (16 digits or more: nanoseconds; with a
/// decimal point: seconds), make a timed sequence. Throws std::runtime_error, one line, at an unreadable or
/// empty folder, unequal counts, names that do not pair, or times not increasing.
ImageSequence folder_sequence(const std::filesystem::path& left, const std::filesystem::path& right);

/// One pair of files. Throws std::runtime_error where one is missing.
ImageSequence single_pair(const std::filesystem::path& left, const std::filesystem::path& right);

}  // namespace understory
