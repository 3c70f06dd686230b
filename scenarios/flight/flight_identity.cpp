#include "scenarios/flight/flight_identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "scenarios/flight/flight.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "sim/render/offscreen_context.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// Regular files, links to folders followed.
std::vector<fs::path> linked_files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::follow_directory_symlink, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
    if (entry->is_regular_file()) files.push_back(entry->path().lexically_relative(folder));
  if (error) refuse_output(folder, error.value());
  std::ranges::sort(files);
  return files;
}

std::string digest_of_models(const fs::path& folder) {
  std::string all;
  for (const fs::path& file : linked_files_below(folder))
    if (*file.begin() != "rigs") all += file.string() + ' ' + digest_of_file(folder / file) + '\n';
  return digest_of_text(all);
}

}  // namespace

OpenedRenderer opened_renderer(RendererKind asked) {
  try {
    OffscreenContext context(asked);
    context.make_current(16, 16);  // now everything that draws is mapped
    return {context.kind(), context.renderer()};
  } catch (const std::runtime_error& error) {
    throw MachineError(error.what());
  }
}

Identity identity_of(const std::vector<Scenario>& scenarios, const fs::path& models_folder,
                     const OpenedRenderer& renderer) {
  Identity identity{{"program", program_digest()},
                    {"libraries", mapped_libraries_digest()},
                    {"renderer", renderer.name},
                    {"models", digest_of_models(models_folder)}};
  std::set<std::string> rigs;
  for (const Scenario& scenario : scenarios) {
    std::string all;
    for (const fs::path& file : rig_files_of(scenario, models_folder)) all += digest_of_file(file) + '\n';
    const std::string name = rig_name_in_identity(scenario);
    if (rigs.insert(name).second) identity.emplace_back(name, digest_of_text(all));
  }
  return identity;
}

Identity pictures_of(const std::vector<Scenario>& scenarios, const fs::path& models_folder,
                     RendererKind renderer) {
  Identity pictures;
  for (const Scenario& one : scenarios) {
    const auto& [word, scenery] = scenery_names[static_cast<std::size_t>(one.world.scenery)];
    if (std::ranges::find(pictures, word, &Identity::value_type::first) != pictures.end()) continue;
    Scenario scenario = scenario_from_text("forest: {length_m: 30}", "a wood for its pictures");
    scenario.world.scenery = scenery;
    const World world = world_of(scenario, models_folder);
    const CalibratedRig rig = rig_of(scenario, models_folder);
    const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 4));
    const StereoFrame frame = cameras_of(scenario, world, rig, renderer)->capture(pose, 0);
    const auto bytes = [](const cv::Mat& image) {
      return std::string_view(image.ptr<char>(), image.total() * image.elemSize());
    };
    pictures.emplace_back(
        word, digest_of_text(digest_of_text(bytes(frame.left)) + digest_of_text(bytes(frame.right))));
  }
  return pictures;
}

std::string rig_name_in_identity(const Scenario& scenario) {
  return "rig " + scenario.rig + (scenario.cameras.raw ? ", raw" : "");
}

std::string digest_of_recording(const fs::path& folder) {
  std::string all;
  for (const fs::path& file : linked_files_below(folder)) {
    const bool is_table = file.extension() == ".csv" || file.extension() == ".yaml";
    all += fmt::format("{} {} {}\n", file.string(), fs::file_size(folder / file),
                       is_table ? digest_of_file(folder / file) : "");
  }
  return digest_of_text(all);
}

}  // namespace understory
