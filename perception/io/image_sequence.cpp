#include "perception/io/image_sequence.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "perception/io/euroc_calibration.hpp"
#include "perception/io/euroc_images.hpp"
#include "perception/io/image_file.hpp"
#include "perception/io/image_names.hpp"
#include "perception/io/text_table.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

void expect(bool holds, const std::string& complaint) {
  if (!holds) throw std::runtime_error(complaint);
}

void expect_file(const fs::path& file, const std::string& whose) {
  std::error_code ignored;
  expect(fs::is_regular_file(file, ignored), file.string() + ": expected " + whose + ", found no such file");
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const bool is_hidden = entry->path().filename().string().starts_with('.');
    if (is_image_name(entry->path()) && !is_hidden) files.push_back(entry->path());
  }
  expect(!error, folder.string() + ": expected a readable folder: " + error.message());
  expect(!files.empty(), folder.string() + ": expected images, found none");
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return comes_before(a.stem().string(), b.stem().string());
  });
  return files;
}

std::vector<std::string> stems_of(const std::vector<fs::path>& files) {
  std::vector<std::string> stems;
  for (const fs::path& file : files) stems.push_back(file.stem().string());
  return stems;
}

/// Puts times from the names, where all the names are times.
void take_times(ImageSequence& sequence) {
  std::vector<std::int64_t> times;
  for (const StereoFiles& pair : sequence.pairs) {
    const auto t_ns = time_in_name(pair.left.stem().string());
    if (!t_ns) return;
    times.push_back(*t_ns);
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    expect(i == 0 || times[i] > times[i - 1],
           sequence.pairs[i].left.string() + ": expected times in the names that increase");
    sequence.pairs[i].t_ns = times[i];
  }
  sequence.timed = true;
}

}  // namespace

ImageSequence euroc_sequence(const fs::path& folder) {
  const auto root = euroc_folder(folder);
  expect(root.has_value(), folder.string() + ": expected a EuRoC folder with mav0/cam0 and mav0/cam1");
  const auto listed = [&](const char* camera) {
    const fs::path list = *root / camera / "data.csv";
    return parse_euroc_images(text_of(list), list.string());
  };
  const std::vector<EurocImage> left = listed("cam0"), right = listed("cam1");
  ImageSequence sequence;
  sequence.timed = true;
  for (auto l = left.begin(), r = right.begin(); l != left.end() && r != right.end();) {
    if (l->t_ns == r->t_ns) {
      const StereoFiles pair{l->t_ns, *root / "cam0" / "data" / l++->file_name,
                             *root / "cam1" / "data" / r++->file_name};
      expect_file(pair.left, "the image that cam0/data.csv lists");
      expect_file(pair.right, "the image that cam1/data.csv lists");
      sequence.pairs.push_back(pair);
    } else {
      l->t_ns < r->t_ns ? ++l : ++r;
    }
  }
  expect(!sequence.pairs.empty(),
         root->string() + ": expected times that both cam0/data.csv and cam1/data.csv list, found none");
  sequence.unpaired = static_cast<std::int64_t>(left.size() + right.size()) -
                      2 * static_cast<std::int64_t>(sequence.pairs.size());
  return sequence;
}

ImageSequence folder_sequence(const fs::path& left, const fs::path& right) {
  const std::vector<fs::path> left_files = images_in(left), right_files = images_in(right);
  if (const auto lone = first_unpaired(stems_of(left_files), stems_of(right_files))) {
    const bool is_left = lone->of_first;
    throw std::runtime_error((is_left ? left_files : right_files)[lone->index].string() +
                             ": expected its partner in " + (is_left ? right : left).string() +
                             ", found none (" + std::to_string(left_files.size()) + " left images, " +
                             std::to_string(right_files.size()) + " right)");
  }
  ImageSequence sequence;
  for (std::size_t i = 0; i < left_files.size(); ++i)
    sequence.pairs.push_back({0, left_files[i], right_files[i]});
  take_times(sequence);
  return sequence;
}

ImageSequence single_pair(const fs::path& left, const fs::path& right) {
  expect_file(left, "the left image");
  expect_file(right, "the right image");
  ImageSequence sequence;
  sequence.pairs.push_back({0, left, right});
  take_times(sequence);
  return sequence;
}

}  // namespace understory
