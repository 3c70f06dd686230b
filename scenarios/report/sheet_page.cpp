#include "scenarios/report/sheet_page.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/report/page.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

/// Adds an array under a name of its own, which it gives.
std::string add(PageArrays& arrays, int& count, const std::vector<double>& values) {
  std::string name = fmt::format("values_{}", count++);
  arrays.add(name, 1, std::vector<float>(values.begin(), values.end()));
  return name;
}

Json json_of(const LinePlot& plot, PageArrays& arrays, int& count) {
  Json json{{"title", plot.title}, {"x_label", plot.x_label}, {"y_label", plot.y_label}};
  json["series"] = Json::array();
  for (const Series& series : plot.series) {
    Json one{{"name", series.name},
             {"x", add(arrays, count, series.x)},
             {"y", add(arrays, count, series.y)},
             {"mark", series.mark == Mark::dots ? "points" : "line"}};
    if (!series.low.empty()) {
      one["lower"] = add(arrays, count, series.low);
      one["upper"] = add(arrays, count, series.high);
    }
    json["series"].push_back(std::move(one));
  }
  if (!plot.x_names.empty()) json["x_names"] = plot.x_names;
  json["references"] = Json::array();
  for (const ReferenceLine& line : plot.references)
    json["references"].push_back({{"at", line.at}, {"label", line.label}, {"vertical", line.vertical}});
  return json;
}

Json json_of(const Table& table) {
  Json columns = Json::array();
  for (const std::string& name : table.head) columns.push_back({{"label", name}, {"unit", ""}});
  return {{"columns", columns}, {"rows", table.rows}};
}

}  // namespace

Json facts_of(const std::vector<SheetSection>& sections, PageContent& page) {
  Json facts = Json::array();
  int arrays = 0;
  // A section of the page has one plot: further ones follow in sections without a title.
  const auto add_section = [&](const std::string& name, const std::string& text) -> Json& {
    facts.push_back({{"title", name},
                     {"text", text},
                     {"plot", nullptr},
                     {"table", nullptr},
                     {"pictures", Json::array()}});
    return facts.back();
  };
  for (const SheetSection& section : sections) {
    Json& first = add_section(section.title, section.text);
    for (const SheetBar& bar : section.bars)
      first["bars"].push_back({{"name", bar.name}, {"parts", bar.parts}});
    if (section.table) first["table"] = json_of(*section.table);
    for (const SheetPicture& picture : section.pictures) {
      const std::string name = fmt::format("picture-{}", page.parts.size());
      page.parts.emplace_back(name, picture.jpeg);
      first["pictures"].push_back({{"caption", picture.caption}, {"block", name}, {"type", "image/jpeg"}});
    }
    for (const LinePlot& plot : section.plots)
      add_section(plot.title, "")["plot"] = json_of(plot, page.arrays, arrays);
  }
  return facts;
}

std::string sheet_page(const std::filesystem::path& data_root, const std::string& title,
                       const std::string& sentence, const std::vector<SheetSection>& sections) {
  PageContent page;
  page.title = title;
  Json facts{{"kind", "sheet"},
             {"title", title},
             {"program", fmt::format("understory {} ({})", understory_version, understory_commit)},
             {"sentence", sentence},
             {"warning", ""}};
  facts["sections"] = facts_of(sections, page);
  page.facts = json_text(facts);
  return page_html(data_root, page);
}

}  // namespace understory
