#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/report/line_plot.hpp"
#include "scenarios/report/page.hpp"
#include "scenarios/report/table.hpp"

namespace understory {

struct SheetPicture {
  std::string caption;
  std::string jpeg;  ///< its bytes
};

/// A bar of parts side by side, whose widths are their shares of the sum.
struct SheetBar {
  std::string name;
  std::vector<std::pair<std::string, double>> parts;
};

/// A part of a page of plots and tables.
struct SheetSection {
  std::string title;
  std::string text = {};  ///< below the title
  std::vector<SheetBar> bars = {};
  std::vector<LinePlot> plots = {};
  std::optional<Table> table = {};
  std::vector<SheetPicture> pictures = {};
};

/// The sections as facts of a page, their numbers and pictures added to `page`.
nlohmann::ordered_json facts_of(const std::vector<SheetSection>& sections, PageContent& page);

/// A page of plots that can be pointed at, tables that can be sorted, and pictures: one HTML file. Throws as
/// page_html does.
std::string sheet_page(const std::filesystem::path& data_root, const std::string& title,
                       const std::string& sentence, const std::vector<SheetSection>& sections);

}  // namespace understory
