#include "scenarios/flight/fly.hpp"

#include <fmt/format.h>

#include <optional>

#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_film.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/flight/flight_page.hpp"
#include "scenarios/flight/run_files.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t progress_every_steps = physics_rate_hz / 10;

class ProgressTeller : public FlightObserver {
 public:
  ProgressTeller(const FlightLog& log, const std::function<void(const FlightProgress&)>& tell)
      : log_(log), tell_(tell) {}

  const char* stage() const override { return "progress"; }
  void on_step(const Flight& flight) override {
    if (flight.clock().step() % progress_every_steps != 0) return;
    const FlightResult& so_far = log_.result;
    tell_({flight.clock().t_s(), flight.stopwatch().elapsed_s(), so_far.progress_m,
           flight.scenario().goal_x_m(), flight.truth().velocity_world_mps.norm(),
           so_far.minimum_clearance_m});
  }

 private:
  const FlightLog& log_;
  const std::function<void(const FlightProgress&)>& tell_;
};

void write_report(const FlightLog& log, const FlyOptions& options, const FlightFilm* film) {
  FlightPageExtras extras{options.models_folder.parent_path()};
  extras.warning = warning_of_digest(log.result, options.expected_digest);
  extras.chapter = options.chapter;
  if (film != nullptr) {
    extras.film = options.output_folder / "flight.mp4";
    extras.film_times_s = film->times_s();
    extras.last_picture = film->last();
  }
  write_whole_file(options.output_folder / "report.html", flight_page(log, extras));
}

}  // namespace

std::string warning_of_digest(const FlightResult& result, const std::string& expected_digest) {
  if (expected_digest.empty() || expected_digest == result.digest) return "";
  return fmt::format(
      "This page shows another flight than the run's: its digest is {}, the run's was {}. Another version of "
      "the program, of a library or another machine flew it.",
      result.digest, expected_digest);
}

FlightResult fly(const Scenario& scenario, const FlyOptions& options) {
  FlightLogger own_logger;
  FlightLogger& logger = options.logger != nullptr ? *options.logger : own_logger;
  std::optional<FlightFilm> film;
  std::optional<ProgressTeller> progress;
  std::vector<FlightObserver*> observers{&logger};
  if (options.video)
    observers.push_back(&film.emplace(options.output_folder, scenario.frame_rate_hz(), logger.log()));
  if (options.on_progress) observers.push_back(&progress.emplace(logger.log(), options.on_progress));
  observers.insert(observers.end(), options.observers.begin(), options.observers.end());

  Flight flight(scenario, {options.models_folder, options.renderer}, std::move(observers));
  while (!flight.outcome()) flight.step();

  const FlightResult& result = logger.log().result;
  std::string lost;
  try {
    if (film) film->finish(flight);
  } catch (const MachineError& error) {  // a film fills a disk: without it there is room for the rest
    lost = error.what();
    film.reset();
  }
  if (!options.output_folder.empty()) write_run_files(logger.log(), options.output_folder);
  if (!options.track.empty() && result.outcome != Outcome::goal)
    write_whole_file(options.track, compact_flight(logger.log()));
  if (options.report) write_report(logger.log(), options, film ? &*film : nullptr);
  if (!lost.empty()) throw LostFilm(lost);
  return result;
}

}  // namespace understory
