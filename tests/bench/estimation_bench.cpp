#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimation/filter.hpp"
#include "simulated_flight.hpp"

/// What the filter costs in flight: one IMU sample (propagation, sideslip, angle of attack, history) and one
/// airspeed reading. A hundred dodges, each of its own sharpness and noise; no sample is used twice.
namespace understory::test {
namespace {

using Clock = std::chrono::steady_clock;

/// One IMU sample and what came with it.
struct Samples {
  ImuSample imu;
  std::optional<PitotSample> pitot;
  std::optional<BarometerSample> barometer;
  std::optional<MagnetometerSample> magnetometer;
};
using Flight = std::vector<Samples>;

class Tape : public StateSource {
 public:
  void on(const Sample& sample) override {
    if (const auto* imu = std::get_if<ImuSample>(&sample)) flight.emplace_back().imu = *imu;
    if (const auto* pitot = std::get_if<PitotSample>(&sample)) flight.back().pitot = *pitot;
    if (const auto* barometer = std::get_if<BarometerSample>(&sample)) flight.back().barometer = *barometer;
    if (const auto* field = std::get_if<MagnetometerSample>(&sample)) flight.back().magnetometer = *field;
  }
  const State& state() const override { return none_; }
  State state_at(std::int64_t) const override { return none_; }
  Flight flight;

 private:
  State none_;
};

Manoeuvre dodge_scaled(double by) {
  Manoeuvre manoeuvre = dodge();
  manoeuvre.roll_rate = [full = manoeuvre.roll_rate, by](double t) { return by * full(t); };
  return manoeuvre;
}

const std::vector<Flight>& flights() {
  static const std::vector<Flight> all = [] {
    std::vector<Flight> made;
    for (int i = 0; i < 100; ++i) {
      Tape tape;
      Sensors sensors({}, 1 + i);
      // To the left and to the right, from straight to a fifth beyond the usual dodge.
      for (const Moment& moment : fly(dodge_scaled(0.024 * (i - 50)), 3.2)) sensors.feed(tape, moment);
      made.push_back(std::move(tape.flight));
    }
    return made;
  }();
  return all;
}

/// Past the launch's stroke, where all of the filter's measurements work.
constexpr std::int64_t flying_ns = 600'000'000;

/// How many samples of one kind the flights have in flight.
template <typename IsOne>
benchmark::IterationCount count(IsOne is_one) {
  benchmark::IterationCount sum = 0;
  for (const Flight& flight : flights())
    for (const Samples& samples : flight) sum += samples.imu.t_ns >= flying_ns && is_one(samples);
  return sum;
}

/// Feeds all flights in turn; each of the counted samples is an iteration, timed alone. The clock's own 20 ns
/// or so are in the figures.
class Player {
 public:
  explicit Player(const FilterConfig& config) : config_(config) { begin(); }

  /// The next samples; at a flight's end, a fresh filter for the next flight.
  const Samples& next() {
    if (sample_ == flights()[flight_].size()) {
      ++flight_;
      begin();
    }
    return flights()[flight_][sample_++];
  }
  Filter& filter() { return *filter_; }

 private:
  void begin() {
    sample_ = 0;
    filter_ = std::make_unique<Filter>(config_);
  }
  FilterConfig config_;
  std::size_t flight_ = 0, sample_ = 0;
  std::unique_ptr<Filter> filter_;
};

template <typename Sample>
double timed_s(Filter& filter, const Sample& sample) {
  const Clock::time_point begin = Clock::now();
  filter.on(sample);
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Beside the mean, which whatever else runs on the machine enters.
void report(benchmark::State& state, std::vector<double>& took_s) {
  const auto quantile_ns = [&](double fraction) {
    const auto nth = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(took_s.size()));
    std::nth_element(took_s.begin(), took_s.begin() + nth, took_s.end());
    return 1e9 * took_s[static_cast<std::size_t>(nth)];
  };
  state.counters["median_ns"] = quantile_ns(0.5);
  state.counters["p99_ns"] = quantile_ns(0.99);
}

void imu_step(benchmark::State& state, const FilterConfig& config) {
  Player player(config);
  std::vector<double> all_took_s;
  all_took_s.reserve(state.max_iterations);
  for (auto _ : state) {
    for (bool flying = false; !flying;) {
      const Samples& samples = player.next();
      flying = samples.imu.t_ns >= flying_ns;
      const double took_s = timed_s(player.filter(), samples.imu);
      if (flying) {
        state.SetIterationTime(took_s);
        all_took_s.push_back(took_s);
      }
      if (samples.pitot) player.filter().on(*samples.pitot);
      if (samples.barometer) player.filter().on(*samples.barometer);
      if (samples.magnetometer) player.filter().on(*samples.magnetometer);
    }
  }
  report(state, all_took_s);
}

void airspeed_update(benchmark::State& state, const FilterConfig& config) {
  Player player(config);
  std::vector<double> all_took_s;
  all_took_s.reserve(state.max_iterations);
  for (auto _ : state) {
    for (bool timed = false; !timed;) {
      const Samples& samples = player.next();
      player.filter().on(samples.imu);
      if (samples.pitot) {
        const double took_s = timed_s(player.filter(), *samples.pitot);
        timed = samples.imu.t_ns >= flying_ns;
        if (timed) {
          state.SetIterationTime(took_s);
          all_took_s.push_back(took_s);
        }
      }
      if (samples.barometer) player.filter().on(*samples.barometer);
      if (samples.magnetometer) player.filter().on(*samples.magnetometer);
    }
  }
  report(state, all_took_s);
}

void register_all() {
  const auto imu_count = count([](const Samples&) { return true; });
  const auto pitot_count = count([](const Samples& samples) { return samples.pitot.has_value(); });
  const std::pair<const char*, FilterConfig> filters[] = {
      {"default", {}}, {"windy", windy_filter()}, {"original", original_filter()}};
  const auto add = [](const std::string& name, auto run, const FilterConfig& config, auto iterations) {
    benchmark::RegisterBenchmark(name.c_str(), run, config)
        ->Iterations(iterations)
        ->UseManualTime()
        ->Unit(benchmark::kNanosecond);
  };
  for (const auto& [name, config] : filters)
    add(std::string("imu_step/") + name, imu_step, config, imu_count);
  for (const auto& [name, config] : filters)
    add(std::string("airspeed_update/") + name, airspeed_update, config, pitot_count);
}

}  // namespace
}  // namespace understory::test

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  understory::test::register_all();
  benchmark::RunSpecifiedBenchmarks();
}
