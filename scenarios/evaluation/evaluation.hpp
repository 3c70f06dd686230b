#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "scenarios/evaluation/recording_evaluation.hpp"

namespace understory {

struct EvaluationOptions {
  std::vector<std::filesystem::path> folders;  ///< recordings of one rig
  EvaluationSettings settings;
  int jobs = 1;  ///< recordings at once; figures do not depend on it, costs do a little
  /// Called after each frame, from one thread at a time.
  std::function<void(std::int64_t frames, std::int64_t expected)> on_progress;
};

struct Evaluation {
  EvaluationSettings settings;
  std::vector<RecordingEvaluation> recordings;  ///< in the folders' order
  EvaluationSum all;
  std::vector<EvaluationSum> scenes;  ///< in order of first appearance
  bool has_depth() const;             ///< any of them
  bool has_objects() const;
  bool has_poses() const;
};

/// Throws ScenarioError, one line, where a folder cannot be read or recordings are of different rigs.
Evaluation evaluate(const EvaluationOptions& options);

}  // namespace understory
