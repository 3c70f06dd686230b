#include "perception/io/euroc_images.hpp"

#include <stdexcept>

#include "perception/io/text_table.hpp"

namespace understory {

std::vector<EurocImage> parse_euroc_images(std::string_view text, const std::string& name) {
  std::vector<EurocImage> images;
  for (const TableLine& line : table_lines(text, CellsParted::by_commas)) {
    const auto t_ns = nanoseconds_in(line.cells[0]);
    const bool is_named =
        line.cells.size() == 2 && !line.cells[1].empty() && line.cells[1].find('/') == std::string_view::npos;
    if (!t_ns || !is_named)
      fail_at_line(name, line.number, "expected 't,file name', t in nanoseconds from 0");
    if (!images.empty() && *t_ns <= images.back().t_ns)
      fail_at_line(name, line.number, "expected times that increase from line to line");
    images.push_back({*t_ns, std::string(line.cells[1])});
  }
  if (images.empty()) throw std::runtime_error(name + ": expected at least one image, found none");
  return images;
}

}  // namespace understory
