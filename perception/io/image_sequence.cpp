#include "perception/io/image_sequence.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "perception/io/image_file.hpp"
#include "perception/io/machine_limits.hpp"
#include "perception/io/text_file.hpp"
#include "perception/io/text_table.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

void expect(bool holds, const std::string& complaint) {
  if (!holds) throw InputError(complaint);
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
  if (const std::string lacking = lacking_resource(error.value()); !lacking.empty())
    throw MachineError(folder.string() + ": " + lacking);
  expect(!error, folder.string() + ": cannot read this folder: " + error.message());
  expect(!files.empty(), folder.string() + ": there are no images in this folder");
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
           sequence.pairs[i].left.string() + ": the times in the names must increase");
    sequence.pairs[i].t_ns = times[i];
  }
  sequence.timed = true;
}

constexpr std::string_view digits = "0123456789";
constexpr std::size_t minimum_digits_of_time = 16;  // nanoseconds since 1970 have 19, since a start-up fewer

bool is_digit(char c) { return digits.find(c) != std::string_view::npos; }

/// The digits that `text` begins with.
std::string_view leading_digits(std::string_view text) {
  return text.substr(0, std::min(text.find_first_not_of(digits), text.size()));
}

/// By value, whatever their count of leading zeros; below 0 where `a` is the smaller.
int compare_digits(std::string_view a, std::string_view b) {
  a.remove_prefix(std::min(a.find_first_not_of('0'), a.size()));
  b.remove_prefix(std::min(b.find_first_not_of('0'), b.size()));
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

/// The last number in the name; nothing where it has none, or one too long.
std::optional<std::int64_t> last_number(std::string_view name) {
  const std::size_t last = name.find_last_of(digits);
  if (last == std::string_view::npos) return std::nullopt;
  const std::size_t before = name.substr(0, last).find_last_not_of(digits);
  const std::size_t first = before == std::string_view::npos ? 0 : before + 1;
  return nanoseconds_in(name.substr(first, last - first + 1));
}

bool counts_on(const std::vector<std::string>& names) {
  for (std::size_t i = 1; i < names.size(); ++i) {
    const auto number = last_number(names[i]), previous = last_number(names[i - 1]);
    if (!number || !previous || *number != *previous + 1) return false;
  }
  return !names.empty() && last_number(names[0]).has_value();
}

bool have_none_in_common(const std::vector<std::string>& first, const std::vector<std::string>& second) {
  return last_number(first.back()) < last_number(second.front()) ||
         last_number(second.back()) < last_number(first.front());
}

/// A name's texts and numbers in turn, numbers by their value: "img_07" as "img_" and "7".
std::vector<std::string> pieces_of(std::string_view name) {
  std::vector<std::string> pieces;
  while (!name.empty()) {
    const std::size_t text = std::min(name.find_first_of(digits), name.size());
    const std::string_view number = leading_digits(name.substr(text));
    pieces.emplace_back(name.substr(0, text));
    pieces.emplace_back(number.substr(std::min(number.find_first_not_of('0'), number.size())));
    name.remove_prefix(text + number.size());
  }
  return pieces;
}

using Keys = std::vector<std::string>;

/// For every name of both folders what pairs it: the pieces in which names of one folder differ, as far as
/// the other folder has any of them. Neither a camera's number nor an image's size does. The names themselves
/// where they are not all built alike, or where two of a folder would have one key.
std::array<Keys, 2> keys_of(const std::array<Keys, 2>& names) {
  std::array<std::vector<Keys>, 2> pieces;
  std::array<Keys, 2> keys;
  for (const std::size_t folder : {0U, 1U})
    for (const std::string& name : names[folder]) pieces[folder].push_back(pieces_of(name));
  for (const std::size_t folder : {0U, 1U})
    for (const Keys& one : pieces[folder])
      if (one.size() != pieces[0].front().size()) return names;
  for (std::size_t i = 0; i < pieces[0].front().size(); ++i) {
    std::array<std::set<std::string>, 2> values;
    for (const std::size_t folder : {0U, 1U})
      for (const Keys& one : pieces[folder]) values[folder].insert(one[i]);
    const bool differs = values[0].size() > 1 || values[1].size() > 1;
    const bool is_common =
        std::ranges::any_of(values[0], [&](const auto& one) { return values[1].contains(one); });
    for (const std::size_t folder : {0U, 1U}) {
      keys[folder].resize(names[folder].size());
      for (std::size_t k = 0; k < keys[folder].size(); ++k)
        if (differs && is_common) keys[folder][k] += pieces[folder][k][i] + ' ';
    }
  }
  for (const Keys& folder : keys)
    if (std::set(folder.begin(), folder.end()).size() != folder.size()) return names;
  return keys;
}

}  // namespace

bool comes_before(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view digits_a = leading_digits(a), digits_b = leading_digits(b);
      if (const int order = compare_digits(digits_a, digits_b); order != 0) return order < 0;
      a.remove_prefix(digits_a.size());
      b.remove_prefix(digits_b.size());
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;  // 07 and 7: any order, but always the same
}

std::optional<std::int64_t> time_in_name(std::string_view stem) {
  if (leading_digits(stem).size() == stem.size())
    return stem.size() < minimum_digits_of_time ? std::nullopt : nanoseconds_in(stem);
  const std::size_t point = leading_digits(stem).size();
  const bool is_decimal = point > 0 && stem[point] == '.' && point + 1 < stem.size() &&
                          leading_digits(stem.substr(point + 1)).size() == stem.size() - point - 1;
  return is_decimal ? seconds_in(stem) : std::nullopt;
}

std::optional<LoneName> first_unpaired(const std::vector<std::string>& first,
                                       const std::vector<std::string>& second) {
  const std::size_t common = std::min(first.size(), second.size());
  const bool same_count = first.size() == second.size();
  if (same_count && counts_on(first) && counts_on(second) && have_none_in_common(first, second))
    return std::nullopt;
  if (common == 0) return same_count ? std::nullopt : std::optional(LoneName{second.empty(), 0});
  const auto keys = keys_of({first, second});
  // Of two that do not belong together, the first has no partner further on.
  for (std::size_t i = 0; i < common; ++i)
    if (keys[0][i] != keys[1][i]) return LoneName{comes_before(keys[0][i], keys[1][i]), i};
  if (same_count) return std::nullopt;
  return LoneName{first.size() > second.size(), common};
}

std::vector<EurocImage> parse_euroc_images(std::string_view text, const std::string& name) {
  std::vector<EurocImage> images;
  constexpr std::array columns{Column{"timestamp|time|t|t_ns", "ns"},
                               Column{"filename|file name|file|name|image"}};
  for (const TableLine& line : named_table(text, CellsParted::by_commas, name, columns).lines) {
    const auto t_ns = nanoseconds_in(line.cells[0]);
    const bool is_named =
        line.cells.size() == 2 && !line.cells[1].empty() && line.cells[1].find('/') == std::string_view::npos;
    if (!t_ns || !is_named)
      fail_at_line(name, line.number, "expected 't,file name', t in nanoseconds from 0");
    if (!images.empty() && *t_ns <= images.back().t_ns)
      fail_at_line(name, line.number, "times must increase from line to line");
    images.push_back({*t_ns, std::string(line.cells[1])});
  }
  if (images.empty()) throw InputError(name + ": lists no image");
  return images;
}

ImageSequence euroc_sequence(const fs::path& folder) {
  const auto root = euroc_folder(folder);
  expect(root.has_value(), folder.string() + ": not a EuRoC folder: that has mav0/cam0 and mav0/cam1");
  const auto listed = [&](const char* camera) {
    const fs::path list = *root / camera / "data.csv";
    return parse_euroc_images(read_file(list, maximum_table_bytes), list.string());
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
         root->string() + ": cam0/data.csv and cam1/data.csv have no time in common");
  sequence.unpaired = static_cast<std::int64_t>(left.size() + right.size()) -
                      2 * static_cast<std::int64_t>(sequence.pairs.size());
  return sequence;
}

ImageSequence folder_sequence(const fs::path& left, const fs::path& right) {
  const std::vector<fs::path> left_files = images_in(left), right_files = images_in(right);
  if (const auto lone = first_unpaired(stems_of(left_files), stems_of(right_files))) {
    const bool is_left = lone->of_first;
    throw InputError((is_left ? left_files : right_files)[lone->index].string() + ": has no partner in " +
                     (is_left ? right : left).string() + " (" + std::to_string(left_files.size()) +
                     " left images, " + std::to_string(right_files.size()) + " right)");
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

std::optional<fs::path> euroc_folder(const fs::path& path) {
  std::error_code ignored;
  for (const fs::path& folder : {path, path / "mav0"})
    if (fs::is_directory(folder / "cam0", ignored)) return folder;
  return std::nullopt;
}

}  // namespace understory
