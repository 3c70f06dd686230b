#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace understory {

/// Alphabetical order, but digits within names by the number they write: img_9 comes before img_10.
bool comes_before(std::string_view a, std::string_view b);

/// The time that a name without its ending writes: 16 digits or more are nanoseconds, digits with a decimal
/// point are seconds. Nothing for any other name.
std::optional<std::int64_t> time_in_name(std::string_view stem);

/// A name of one list that has no partner in the other.
struct LoneName {
  bool of_first = true;  ///< it stands in the first list
  std::size_t index = 0;
};

/// The names of two cameras' images, each list sorted by comes_before: nothing where the n-th names belong
/// together for every n, otherwise the first name that stands alone. They belong together where equal, or
/// where the last number in them is equal, or where both lists count on by one from name to name and have no
/// number in common.
std::optional<LoneName> first_unpaired(const std::vector<std::string>& first,
                                       const std::vector<std::string>& second);

}  // namespace understory
