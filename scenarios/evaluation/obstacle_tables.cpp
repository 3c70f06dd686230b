#include "scenarios/evaluation/obstacle_tables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/evaluation/share_text.hpp"
#include "scenarios/statistics/samples.hpp"

namespace understory {

EvaluationTable computer_table(const Evaluation& evaluation) {
  EvaluationTable table{"computer",
                        "On the aircraft's computer (perception.compute), each looking as often as it can: "
                        "obstacles with 95 % intervals after Wilson",
                        {{"algorithm", "looks/s", "precision", "found within 1 m", "found within 3 m"}, {}}};
  const EvaluationSum& all = evaluation.all;
  for (std::size_t i = 0; i < paced_algorithms.size(); ++i) {
    const PacedResult& paced = all.paced[i];
    const AlgorithmIndex algorithm = paced_algorithms[i];
    table.table.rows.push_back(
        {algorithm_names[algorithm],
         fmt::format("{:.1f}", all.seconds > 0 ? static_cast<double>(paced.looks) / all.seconds : 0),
         share_text(all.tallies[algorithm].precision[one_pixel]),
         wilson_text(found_within(paced.sightings, 1)), wilson_text(found_within(paced.sightings, 3))});
  }
  return table;
}

EvaluationTable on_the_path_table(const Evaluation& evaluation) {
  EvaluationTable table{"on_the_path",
                        "Obstacles that a wing would touch, straight on from where they came into view",
                        {{"algorithm", "obstacles", "found", "hits each, median", "lowest tenth",
                          "first hit at, m, median", "third hit at, m, median"},
                         {}}};
  for (std::size_t i = 0; i < algorithm_count; ++i) {
    Share found;
    std::vector<double> hits, first_m, third_m;
    for (const ObstacleSighting& sighting : evaluation.all.sightings[i]) {
      if (!sighting.on_the_path || sighting.hidden()) continue;
      found.count(sighting.found());
      hits.push_back(sighting.hits);
      if (sighting.hits >= 1) first_m.push_back(sighting.first_hit_m);
      if (sighting.found()) third_m.push_back(sighting.third_hit_m);
    }
    const auto middle = [](const std::vector<double>& values, const char* format) {
      return values.empty() ? std::string("-") : fmt::format(fmt::runtime(format), quantile(values, 0.5));
    };
    table.table.rows.push_back({algorithm_names[i], fmt::format("{}", found.of), share_text(found),
                                middle(hits, "{:.0f}"),
                                hits.empty() ? "-" : fmt::format("{:.0f}", quantile(hits, 0.1)),
                                middle(first_m, "{:.2f}"), middle(third_m, "{:.2f}")});
  }
  return table;
}

Table obstacles_table(const Evaluation& evaluation) {
  Table table{{"recording", "object", "name", "kind", "miss_m", "on_the_path", "hidden", "blocks_in_view",
               "hits", "first_hit_m", "third_hit_m"},
              {}};
  for (const RecordingEvaluation& recording : evaluation.recordings)
    for (const ObstacleSighting& sighting : recording.sightings[our_rule]) {
      const auto object = std::ranges::find(recording.objects, sighting.object, &RecordedObject::number);
      table.rows.push_back({recording.folder.filename().string(), fmt::format("{}", sighting.object),
                            object->name, object->kind, fmt::format("{:.3f}", sighting.miss_m),
                            sighting.on_the_path ? "1" : "0", sighting.hidden() ? "1" : "0",
                            fmt::format("{}", sighting.blocks_in_view), fmt::format("{}", sighting.hits),
                            fmt::format("{:.3f}", sighting.first_hit_m),
                            fmt::format("{:.3f}", sighting.third_hit_m)});
    }
  return table;
}

}  // namespace understory
