#include "scenarios/campaign/data_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "perception/io/text_file.hpp"
#include "scenarios/campaign/engines.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// A recording's table that has a line for each stereo pair.
const char* table_of(RecordingForm form) {
  return form == RecordingForm::euroc   ? "mav0/cam0/data.csv"
         : form == RecordingForm::kitti ? "training/times.txt"
                                        : "pairs/times.txt";
}

std::ptrdiff_t pairs_in(const fs::path& table) {
  const std::string text = read_file(table, maximum_table_bytes);
  return std::ranges::count(text, '\n') - (text.starts_with('#') ? 1 : 0);
}

}  // namespace

void write_data_set_files(const CampaignFolder& folder, const std::vector<FlightRow>& rows,
                          RecordingForm form) {
  std::string scenes = "folder,condition,seed,pairs,outcome\n";
  for (const FlightRow& row : rows)
    if (const fs::path run = fs::path("runs") / row.id; row.flown())
      scenes += fmt::format("{},{},{},{},{}\n", run.string(), row.condition, row.seed,
                            pairs_in(folder.path / run / table_of(form)), row.outcome);
  write_whole_file(folder.path / "scenes.csv", scenes);
  write_whole_file(
      folder.path / "LICENSE.txt",
      fmt::format("SPDX-License-Identifier: CC0-1.0\n\n"
                  "understory {} computed this data set from the scenarios in conditions/. Its "
                  "images show nothing that exists. Its maker gives it to the public domain "
                  "(https://creativecommons.org/publicdomain/zero/1.0) by leaving this file as it "
                  "is. Where a scenario names an inventory of stems, the inventory's own terms "
                  "hold for the positions of its trunks.\n",
                  understory_version));
  const std::string command = fmt::format(
      "cd {} && find runs conditions scenes.csv -type f | LC_ALL=C sort | tr '\\n' '\\0' | "
      "xargs -0 sha256sum > SHA256SUMS",
      quoted(folder.path.string()));
  if (std::system(command.c_str()) != 0)
    throw MachineError(
        fmt::format("{}: sha256sum could not write it", (folder.path / "SHA256SUMS").string()));
}

}  // namespace understory
