#include "perception/io/image_sequence.hpp"

#include <algorithm>
#include <string>

#include "tests/fuzz/recorded_text.hpp"

namespace {

using Names = std::vector<std::string>;

Names sorted_lines(std::string_view text) {
  Names names;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    names.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  std::sort(names.begin(), names.end(), understory::comes_before);
  return names;
}

}  // namespace

/// The names of two folders' images, a line each, cut apart at the first line of '='.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understory;
  constexpr std::string_view cut = "====\n";
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t at = std::min(text.find(cut), text.size());
  const Names left = sorted_lines(text.substr(0, at));
  const Names right = sorted_lines(text.substr(std::min(at + cut.size(), text.size())));
  for (const Names* names : {&left, &right})
    for (std::size_t i = 0; i < names->size(); ++i) {
      fuzz::require(time_in_name((*names)[i]).value_or(0) >= 0, "a time from 0");
      // Sorted, every earlier name is not after a later one: what an order must keep to.
      for (std::size_t k = 0; k < i; ++k)
        fuzz::require(!comes_before((*names)[i], (*names)[k]), "an order without circles");
    }
  if (const auto lone = first_unpaired(left, right))
    fuzz::require(lone->index < (lone->of_first ? left : right).size(), "a name of the list");
  else
    fuzz::require(left.size() == right.size(), "as many left as right");
  return 0;
}
