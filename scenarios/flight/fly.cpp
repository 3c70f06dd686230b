#include "scenarios/flight/fly.hpp"

#include <optional>

#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_film.hpp"
#include "scenarios/flight/run_record.hpp"

namespace understory {
namespace {

constexpr std::int64_t progress_every_steps = physics_rate_hz / 10;

class ProgressTeller : public FlightObserver {
 public:
  ProgressTeller(const RunRecord& record, const std::function<void(const FlightProgress&)>& tell)
      : record_(record), tell_(tell) {}

  const char* stage() const override { return "progress"; }
  void on_step(const Flight& flight) override {
    if (flight.clock().step() % progress_every_steps != 0) return;
    const FlightResult& so_far = record_.so_far();
    tell_({flight.clock().t_s(), flight.stopwatch().elapsed_s(), so_far.progress_m,
           flight.scenario().goal_x_m(), flight.truth().velocity_world_mps.norm(), so_far.min_clearance_m});
  }

 private:
  const RunRecord& record_;
  const std::function<void(const FlightProgress&)>& tell_;
};

}  // namespace

FlightResult fly(const Scenario& scenario, const FlyOptions& options) {
  RunRecord record;
  std::optional<FlightFilm> film;
  std::optional<ProgressTeller> progress;
  std::vector<FlightObserver*> observers{&record};
  if (options.video) observers.push_back(&film.emplace(options.output_folder, scenario.frame_rate_hz()));
  if (options.on_progress) observers.push_back(&progress.emplace(record, options.on_progress));
  observers.insert(observers.end(), options.observers.begin(), options.observers.end());

  Flight flight(scenario, {options.models_folder, options.renderer}, std::move(observers));
  while (!flight.ending()) flight.step();

  const FlightResult result = record.finish(flight);
  std::string lost;
  try {
    if (film) film->finish();
  } catch (const MachineError& error) {  // a film fills a disk: without it there is room for the rest
    lost = error.what();
    film.reset();
  }
  if (!options.output_folder.empty()) record.write(options.output_folder);
  if (!lost.empty()) throw LostFilm(lost);
  return result;
}

}  // namespace understory
