#pragma once

#include <string>
#include <vector>

#include "scenarios/explain/evidence.hpp"
#include "scenarios/explain/explain_run.hpp"
#include "scenarios/report/sheet_page.hpp"
#include "scenarios/report/table.hpp"

namespace understory {

/// explain.json of a run.
std::string to_json(const ExplainedFlight& explained);
/// Throws ScenarioError, naming `name`, where the text is none.
ToldExplanation explanation_from_json(const std::string& text, const std::string& name);

/// The chapter of a flight's page: one sentence, the chances over the moments, the effects.
std::vector<SheetSection> explanation_chapter(const ToldExplanation& told);

/// A row for each part: how many survived from each decisive moment on, with it and as control over the same
/// noise, and its effect with its interval.
Table effects_table(const Explanation& explanation);
/// A row for each moment: how many of the control's redraws survived, and the fitted chance.
Table chances_table(const Explanation& explanation);

}  // namespace understory
