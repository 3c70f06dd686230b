#include <nlohmann/json.hpp>

#include "scenarios/tuning/asked_tuning.hpp"
#include "tests/fuzz/recorded_text.hpp"

namespace {

using namespace understory;

struct StandIn : Judge {
  Measured measure(const std::string&, const Scenario&, Look) override { return {{{1, 1, 1, 1}}, {}}; }
  Figures figures(std::span<const Counts> units) const override { return units.front(); }
};

TuneFile some_tuning() {
  TuneFile file;
  file.space.parameters.push_back({.key = "perception.pushbroom.score_limit", .from = 0.05, .to = 0.4});
  file.figures = flight_figure_names;
  file.objective = {.goals = {{0, true}}};
  file.search = {.method = SearchMethod::random, .trials = 20};
  file.scenario_point = {0.2};
  return file;
}

}  // namespace

/// Lines, each a question.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const TuneFile file = some_tuning();
  StandIn judge;
  AskedTuning tuning(file, [&](bool) -> Judge& { return judge; });
  std::istringstream lines{std::string(fuzz::text_of(data, size))};
  for (std::string line; std::getline(lines, line);) {
    const auto answer = nlohmann::json::parse(tuning.answer(line), nullptr, false);
    fuzz::require(answer.is_object() && answer.size() > 0, "an answer in JSON");
  }
  return 0;
}
