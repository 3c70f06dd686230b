#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
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
  std::int64_t unpaired = 0;  ///< images left out, because the other camera took none at that moment
};

/// The pairs of a EuRoC/ASL data set: images that both cameras' data.csv list at the same nanosecond. Throws
/// InputError, one line, at a broken or missing list, a listed image that is not there, or no pair.
ImageSequence euroc_sequence(const std::filesystem::path& folder);

/// The pairs of two folders of images. Sorted by name, numbers within names by value, the n-th left belongs
/// to the n-th right; to be sure that none is missing, the names (without ending) must be equal, or else be
/// numbered alike (left_07, right_07), or each be numbered without a gap and with no number in common
/// (0 .. 9, 10 .. 19). Names that are times, as data sets write them (16 digits or more: nanoseconds; with a
/// decimal point: seconds), make a timed sequence. Throws InputError, one line, at an unreadable or
/// empty folder, unequal counts, names that do not pair, or times not increasing.
ImageSequence folder_sequence(const std::filesystem::path& left, const std::filesystem::path& right);

/// One pair of files. Throws InputError where one is missing.
ImageSequence single_pair(const std::filesystem::path& left, const std::filesystem::path& right);

/// One line of a EuRoC/ASL camera's data.csv.
struct EurocImage {
  std::int64_t t_ns = 0;
  std::string file_name;  ///< within the data folder beside data.csv; no path
};

/// Reads the text of a data.csv: "t,file name", nanoseconds, times strictly increasing. `name` stands for the
/// file in messages. Throws InputError "name:line: what was expected" at a broken line, and where no
/// image is listed.
std::vector<EurocImage> parse_euroc_images(std::string_view text, const std::string& name);

/// Alphabetical order, but digits within names by the number they write: img_9 comes before img_10.
bool comes_before(std::string_view a, std::string_view b);

/// The time that a file name without its extension states: 16 digits or more are nanoseconds, digits with a
/// decimal point are seconds. Nothing for any other name.
std::optional<std::int64_t> time_in_name(std::string_view stem);

/// A name of one list that has no partner in the other.
struct LoneName {
  bool of_first = true;  ///< it stands in the first list
  std::size_t index = 0;
};

/// The names of two cameras' images, each list sorted by comes_before: nothing where the n-th names belong
/// together for every n, otherwise the first name that stands alone. They belong together if they are equal,
/// if their last numbers are equal, or if in both lists the numbers increase by one from name to name and
/// none is in both.
std::optional<LoneName> first_unpaired(const std::vector<std::string>& first,
                                       const std::vector<std::string>& second);

/// The folder that has cam0 and cam1: `path` or its mav0; empty if neither has them.
std::optional<std::filesystem::path> euroc_folder(const std::filesystem::path& path);

}  // namespace understory
