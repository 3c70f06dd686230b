#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/cli/command_line.hpp"
#include "scenarios/recording/recording_choice.hpp"
#include "scenarios/scenario/data_files.hpp"
#include "sim/render/renderer_kind.hpp"

/// Arguments that several commands take, and what their words mean.
namespace understory {

struct CalibrationOptions;
struct GateRule;
struct VisionConfigSources;

/// --set, and --plugin.
void add_settings_option(Command& command, std::vector<std::string>& settings);
/// --plugin alone.
void add_plugin_option(Command& command);
/// --with alone.
void add_with_option(Command& command, std::vector<std::string>& with);
/// --preset, --with and --set, as commands that look at recordings have them.
void add_vision_options(Command& command, VisionConfigSources& sources);
/// --renderer, as every command that draws has it.
void add_renderer_option(Command& command, RendererKind& renderer);
/// The option `name` for a data set's form, and --every.
void add_recording_options(Command& command, const std::string& name, RecordingChoice& choice,
                           const std::string& meaning);
/// --jobs, how many of `what` at a time; 0 if it is not given.
void add_jobs_option(Command& command, int& jobs, const std::string& what);
/// `jobs`, or one a core if that is 0.
int jobs_or_cores(int jobs);

/// --margin, --alpha and --tolerate, as every command that judges two campaigns has them.
void add_rule_options(Command& command, GateRule& rule, std::vector<std::string>& tolerances);
/// The rule with what the words of --tolerate say. Throws ScenarioError if they are invalid.
GateRule rule_of(GateRule rule, const std::vector<std::string>& tolerances);

/// --unit, --size and --depth, as every command that reads a calibration has them.
struct CalibrationArguments {
  std::string unit;               ///< empty: nothing is said
  std::string size;               ///< empty: the files say it
  std::optional<double> depth_m;  ///< nothing: the rig's own
};
void add_calibration_options(Command& command, CalibrationArguments& arguments);
/// The options that they state. Throws ScenarioError if they are invalid.
CalibrationOptions calibration_options(const CalibrationArguments& arguments);

}  // namespace understory
