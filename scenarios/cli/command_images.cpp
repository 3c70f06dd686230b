#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/evaluation/evaluation.hpp"
#include "scenarios/evaluation/image_statistics.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/report/table.hpp"

namespace understory {
namespace {

struct ImagesArguments {
  std::vector<std::string> folders;
  std::string csv, page;  // files; empty: none
  int every = 1, width_px = 0;
};

int run_images(const ImagesArguments& arguments) {
  for (const std::string& output : {arguments.csv, arguments.page}) require_writable(output);
  require_separate({arguments.csv, arguments.page}, {});
  std::vector<std::pair<std::string, std::vector<ImagePair>>> sources;
  for (const std::string& folder : arguments.folders) {
    const std::string scene = scene_of(folder);
    auto source = std::ranges::find(sources, scene, &decltype(sources)::value_type::first);
    if (source == sources.end()) source = sources.insert(sources.end(), {scene, {}});
    for (const ImagePair& pair : read_image_pairs(folder, arguments.every))
      source->second.push_back(arguments.width_px > 0 ? narrowed(pair, arguments.width_px) : pair);
  }
  std::vector<ImageStatistics> all;
  for (const auto& [scene, pairs] : sources) all.push_back(image_statistics(scene, pairs));
  const Table table = image_table(all);
  if (!arguments.csv.empty()) write_whole_file(arguments.csv, to_csv(table));
  if (!arguments.page.empty()) write_whole_file(arguments.page, image_page(all, data_root()));
  fmt::print("{}", to_text(table));
  return exit_goal;
}

}  // namespace

void add_images_command(CommandLine& line) {
  const auto arguments = std::make_shared<ImagesArguments>();
  Command& command = line.add({"images",
                               "measure what a block matcher depends on in stereo pairs, real or rendered: "
                               "spectrum, edges, noise, true and false matches",
                               "understory images recordings/woods-1000 euroc/V1_01_easy --width 376"});
  command.texts(
      "FOLDER", "FOLDER", arguments->folders,
      "recordings in EuRoC layout; folders with left.png and right.png (and disparity.png or .pfm), or "
      "folders of these; recordings of one scene (woods-1, woods-2) are one source",
      1);
  command.whole("--width", arguments->width_px, 32, 8192,
                "make wider images this wide first, so that sources are alike in size");
  command.whole("--every", arguments->every, 1, 1000, "use every N-th pair of recordings only");
  command.text("--csv", "FILE", arguments->csv, "write the table as CSV");
  command.text("--page", "FILE", arguments->page,
               "write a page with the table, spectra and edge sums (HTML)");
  command.runs([arguments] { return run_images(*arguments); });
}

}  // namespace understory
