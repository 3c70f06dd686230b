#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "perception/field_visitor.hpp"
#include "perception/io/text_tree.hpp"

namespace understory {

/// Takes values for the fields from a map of keys. Fields without a key in the map keep their values. Throws
/// InputError "file:line: key: expected ..., got ..." for a wrong type, for a value out of range, and for
/// keys that no field has; with Keys::all_required also for a field without a key, unless it is optional.
/// `path` stands before the keys in messages.
enum class Keys { optional, all_required };
void read_fields(const TextNode& map, const Fields& fields, const std::string& path = "",
                 Keys keys = Keys::optional);

template <typename Config>
void read_config(const TextNode& map, Config& config) {
  read_fields(map, fields_of(config));
}

/// One of the numbers of a field, in the fewest digits that read back exactly.
std::string number_text(const FieldNumbers& numbers, double value);

/// " (did you mean NAME?)", with the known name that is most similar to `word`; empty if none is similar.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace understory
