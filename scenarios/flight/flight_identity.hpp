#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/output/program.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/render/renderer_kind.hpp"

namespace understory {

struct OpenedRenderer {
  RendererKind kind;  ///< osmesa or egl, never automatic
  std::string name;   ///< as OffscreenContext::renderer()
};

/// Opens a renderer: from now on this process draws with it. Throws MachineError where it cannot be opened.
OpenedRenderer opened_renderer(RendererKind asked);

/// The identity of flights of this program as it is loaded: its file, the libraries it has mapped (the
/// renderer's too), the renderer's name, all of the models folder but its rigs, and each scenario's rig.
/// Throws ScenarioError where a rig is missing.
Identity identity_of(const std::vector<Scenario>& scenarios, const std::filesystem::path& models_folder,
                     const OpenedRenderer& renderer);

/// Each scenery of the scenarios, with the digest of a pair of images of one wood of it: renderers that draw
/// it alike fly alike.
Identity pictures_of(const std::vector<Scenario>& scenarios, const std::filesystem::path& models_folder,
                     RendererKind renderer);

/// The name of a scenario's rig in an identity.
std::string rig_name_in_identity(const Scenario& scenario);

/// Digest of everything in a recording's folder: names and sizes of its files, contents of its tables.
std::string digest_of_recording(const std::filesystem::path& folder);

}  // namespace understory
