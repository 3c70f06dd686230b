#include "perception/io/image_names.hpp"

#include <algorithm>

#include "perception/io/text_table.hpp"

namespace understory {
namespace {

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

bool belong_together(const std::string& a, const std::string& b) {
  const auto number = last_number(a);
  return a == b || (number && number == last_number(b));
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
  for (std::size_t i = 0; i < common; ++i) {
    if (belong_together(first[i], second[i])) continue;
    // Of the two that meet here, the one that comes first in order has no partner further on.
    const auto number = last_number(first[i]), other = last_number(second[i]);
    const bool by_number = number && other && *number != *other;
    return LoneName{by_number ? *number < *other : comes_before(first[i], second[i]), i};
  }
  if (same_count) return std::nullopt;
  return LoneName{first.size() > second.size(), common};
}

}  // namespace understory
