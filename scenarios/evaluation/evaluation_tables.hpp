#pragma once

#include <string>
#include <vector>

#include "scenarios/evaluation/evaluation.hpp"
#include "scenarios/report/table.hpp"

namespace understory {

/// A table with its name, as a file's name and as a title.
struct EvaluationTable {
  std::string file;   ///< "algorithms"
  std::string title;  ///< one line
  Table table;        ///< cells are plain numbers or words; units stand in the head
};

/// All that the recordings allow to say, in the order in which people read it: against the paper's figures,
/// all algorithms, scenes, obstacles passed, parts, false hits, invariance.
std::vector<EvaluationTable> evaluation_tables(const Evaluation& evaluation);

/// A line per obstacle passed: what each became under our rule.
Table obstacles_table(const Evaluation& evaluation);

}  // namespace understory
