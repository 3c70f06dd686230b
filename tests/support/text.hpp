#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace understory::support {

/// Expects `text` to hold `part`.
inline void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in:\n" << text;
}
inline void expect_no_part(const std::string& text, const std::string& part) {
  EXPECT_EQ(text.find(part), std::string::npos) << "'" << part << "' is in:\n" << text;
}

/// What the one line says with which `work` is refused, by an Error; empty where it is not.
template <typename Error = std::runtime_error, typename Work>
std::string refusal_of(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    expect_no_part(error.what(), "\n");
    return error.what();
  }
  return "";
}

}  // namespace understory::support
