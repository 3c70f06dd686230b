#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/validation/section.hpp"

namespace understory {

/// A markdown table. Every row as long as the header.
std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows);

std::string to_markdown(const ValidationPage& page);
/// A line for each check, as the terminal shows it.
std::string check_lines(const ValidationPage& page);
int broken_checks(const ValidationPage& page);

/// Writes FILE.md and FILE/*.svg into `folder`. Throws as write_whole_file does.
void write_page(const ValidationPage& page, const std::filesystem::path& folder);

}  // namespace understory
