#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/evaluation/recording_evaluation.hpp"

namespace understory {

struct EvaluationProgress {
  std::int64_t frames = 0;
  std::int64_t frames_expected = 0;
  double wall_s = 0;
};

struct EvaluationOptions {
  std::vector<std::filesystem::path> folders;  ///< recordings of one rig
  EvaluationSettings settings;
  int jobs = 1;  ///< recordings at once; figures do not depend on it, costs do a little
  std::function<void(const EvaluationProgress&)> on_progress;  ///< may be empty
};

/// What some recordings say together.
struct EvaluationSum {
  std::string name;  ///< of the scene; "all"
  std::int64_t frames = 0, recordings = 0;
  double seconds = 0;
  std::array<VisionTally, algorithm_count> tallies;
  std::array<std::vector<ObstacleSighting>, algorithm_count> sightings;
  std::array<PacedResult, paced_algorithms.size()> paced;
  std::array<std::int64_t, algorithm_count> hits{};
  std::array<std::vector<double>, algorithm_count> cost_ms;
  std::array<PublishedScores, 3> published;
  std::vector<InvarianceRow> invariance;
  std::vector<PrecisionRecallCurve> curves;

  void add(const RecordingEvaluation& recording);
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

/// Those of `sightings` that the path came within `reach_m` of, in view at a depth looked at: how many, and
/// how many were found. `hidden`, where asked for: the others.
Share found_within(const std::vector<ObstacleSighting>& sightings, double reach_m,
                   std::int64_t* hidden = nullptr);

}  // namespace understory
