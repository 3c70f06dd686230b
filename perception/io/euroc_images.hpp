#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace understory {

/// One line of a EuRoC/ASL camera's data.csv.
struct EurocImage {
  std::int64_t t_ns = 0;
  std::string file_name;  ///< within the data folder beside data.csv; no path
};

/// Reads the text of a data.csv: "t,file name", nanoseconds, times strictly increasing. `name` stands for the
/// file in messages. Throws std::runtime_error "name:line: what was expected" at a broken line, and where no
/// image is listed.
std::vector<EurocImage> parse_euroc_images(std::string_view text, const std::string& name);

}  // namespace understory
