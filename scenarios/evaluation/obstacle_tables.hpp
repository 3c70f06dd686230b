#pragma once

#include "scenarios/evaluation/evaluation_tables.hpp"

namespace understory {

/// Obstacles found where each algorithm looks as often as the aircraft's computer lets it.
EvaluationTable computer_table(const Evaluation& evaluation);

/// Obstacles that a wing would touch: found, by how many hits, how far off.
EvaluationTable on_the_path_table(const Evaluation& evaluation);

/// A line per obstacle passed: what each became under our rule.
Table obstacles_table(const Evaluation& evaluation);

}  // namespace understory
