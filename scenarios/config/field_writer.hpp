#pragma once

#include <string>

#include "perception/field_visitor.hpp"

namespace understory {

/// The fields as YAML, in their order. Numbers have the fewest digits that read back exactly, so writing and
/// reading again gives the same struct.
std::string write_fields(const Fields& fields);

template <typename Config>
std::string write_config(Config config) {  // by value: visitors take fields that they could change
  return write_fields(fields_of(config));
}

/// The value of a field of numbers: "1", "[1, 2.5]", "~" for an optional one without a value.
std::string value_text(const FieldNumbers& numbers);

}  // namespace understory
