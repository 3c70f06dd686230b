#include "scenarios/flight/fly.hpp"

#include <fmt/format.h>

#include <optional>

#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_film.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/flight/flight_page.hpp"
#include "scenarios/flight/flight_story.hpp"
#include "scenarios/flight/flight_track.hpp"
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

std::string warning_of(const FlightResult& result, const std::string& expected_digest) {
  if (expected_digest.empty() || expected_digest == result.digest) return "";
  return fmt::format(
      "This page shows another flight than the run's: its digest is {}, the run's was {}. Another version of "
      "the "
      "program, of a library or another machine flew it.",
      result.digest, expected_digest);
}

/// The page, and the track for a campaign's.
void write_story(const Flight& flight, const FlightResult& result, const FlyOptions& options,
                 TrackRecorder& recorder, const FlightFilm* film) {
  const fs::path root = options.models_folder.parent_path();
  const bool keeps_track = !options.track.empty() && result.outcome != Outcome::goal;
  if (!options.report && !keeps_track) return;
  const FlightTrack track = recorder.finish(flight);
  const FlightStory story = story_of(flight, track);
  if (keeps_track)
    write_whole_file(options.track, compact_flight(flight, result, track, story), Named::by_user);
  if (!options.report) return;
  FlightPageExtras extras{root, warning_of(result, options.expected_digest)};
  if (film != nullptr) {
    extras.film = options.output_folder / "flight.mp4";
    extras.film_times_s = film->times_s();
    extras.last_picture = film->last();
  }
  write_whole_file(options.output_folder / "report.html", flight_page(flight, result, track, story, extras));
}

}  // namespace

FlightResult fly(const Scenario& scenario, const FlyOptions& options) {
  FlightLogger logger;
  std::optional<FlightFilm> film;
  std::optional<TrackRecorder> track;
  std::optional<ProgressTeller> progress;
  std::vector<FlightObserver*> observers{&logger};
  if (options.video) observers.push_back(&film.emplace(options.output_folder, scenario.frame_rate_hz()));
  if (options.report || !options.track.empty()) observers.push_back(&track.emplace());
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
  if (track) write_story(flight, result, options, *track, film ? &*film : nullptr);
  if (!lost.empty()) throw LostFilm(lost);
  return result;
}

}  // namespace understory
