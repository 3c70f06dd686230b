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

/// A part of a page of plots and tables.
struct SheetSection {
  std::string title;
  std::string text = {};  ///< below the title
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
