#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/scenario/filter_for_sensors.hpp"
#include "sim/sensors/sensors_config.hpp"
#include "tests/validation/drift.hpp"
#include "tests/validation/sections.hpp"

namespace understory {
namespace {

constexpr std::uint64_t drift_seed = 1100;  // development seeds, none of those the filter was tuned on
constexpr std::uint64_t drift_sensor_seed = 7000;
constexpr double sight_m = 10;

/// One switch of the filter, or another filter or grade of sensors.
struct Variant {
  const char* name;
  const char* computed;  ///< drift in dodges [15]: calm; 3 m/s; and turbulence
  void (*change)(TrialConfig&);
};

void second_depth(TrialConfig& config) { config.resightings.enabled = true; }
void satellites(TrialConfig& config) { config.sensors.gps.enabled = true; }
void windy(TrialConfig& config) { take_preset(config, windy_filter()); }

void original(TrialConfig& config) {
  const StartConfig start = config.filter.start;
  config.filter = original_filter();
  config.filter.start.position_world_m = start.position_world_m;
  config.filter.start.pitch_rad = start.pitch_rad;
}

void no_sideslip_model(TrialConfig& config) {
  config.filter.sideslip.model = SideslipModel::zero;
  config.filter.sideslip.zero_sigma_mps = 0.5;
  config.filter.distrust.exclude = false;
}

void waking_in_flight(TrialConfig& config) {
  windy(config);
  config.ground_velocity_unknown = true;
}

/// The filter knows its sensors.
void graded(TrialConfig& config, SensorGrade grade) {
  config.sensors = sensors_of_grade(grade);
  config.filter = filter_for_sensors(config.filter, config.sensors);
}

void windy_graded(TrialConfig& config, SensorGrade grade) {
  windy(config);
  second_depth(config);
  graded(config, grade);
}

enum Row : std::size_t { row_default = 2, row_windy = 8, row_second = 9, row_gps = 10, row_unknown = 11 };

const std::vector<Variant> variants{
    {"states and noise of the original aircraft's filter", "1.80; 3.7; 3.9", original},
    {"default, sideslip assumed to be zero (v_y = 0)", "0.73; 3.7; 4.0", no_sideslip_model},
    {"**default**: 12 states, biases, sideslip from lateral force", "0.12; 4.1; 4.5", [](TrialConfig&) {}},
    {"default without accelerometer bias", "",
     [](TrialConfig& c) { c.filter.states.accelerometer_bias = false; }},
    {"default without pitot bias", "", [](TrialConfig& c) { c.filter.states.pitot_bias = false; }},
    {"default, plus angle of attack from normal force", "",
     [](TrialConfig& c) { c.filter.angle_of_attack.enabled = true; }},
    {"default, corrections also change position and heading", "",
     [](TrialConfig& c) { c.filter.smooth_frame = false; }},
    {"windy preset without gust states", "", [](TrialConfig& c) { windy(c), c.filter.states.gust = false; }},
    {"**windy preset**: wind and gust states; ground velocity from the launch", "0.33; 0.66; 1.04", windy},
    {"windy, obstacles seen at a second depth (10 and 5 m)", "0.36; 0.51; 0.62",
     [](TrialConfig& c) { windy(c), second_depth(c); }},
    {"windy, second depth and GPS", "0.17; 0.24; 0.30",
     [](TrialConfig& c) { windy(c), second_depth(c), satellites(c); }},
    {"windy, started in flight: ground velocity unknown", "", waking_in_flight},
    {"started in flight, with second depth", "",
     [](TrialConfig& c) { waking_in_flight(c), second_depth(c); }},
    {"started in flight, with GPS", "", [](TrialConfig& c) { waking_in_flight(c), satellites(c); }},
    {"default, consumer sensors", "", [](TrialConfig& c) { graded(c, SensorGrade::consumer); }},
    {"default, rough sensors", "", [](TrialConfig& c) { graded(c, SensorGrade::rough); }},
    {"windy and second depth, consumer sensors", "",
     [](TrialConfig& c) { windy_graded(c, SensorGrade::consumer); }},
    {"windy and second depth, rough sensors", "",
     [](TrialConfig& c) { windy_graded(c, SensorGrade::rough); }},
};

const std::vector<double> sights_m{3, 5, 7.5, sight_m, 15};
constexpr std::size_t at_sight = 3;  // sight_m's place

/// Squared errors of the ground velocity in a tenth of a second since the release.
struct VelocityError {
  double since_release_s, squared_sum = 0;
  int count = 0;
  double rms_mps() const { return std::sqrt(squared_sum / count); }
};

/// One variant in one air, all flights together.
struct DriftSample {
  std::vector<DriftTally> drifts{sights_m.size()};
  std::vector<VelocityError> velocity = {};  ///< for six seconds

  const DriftTally& drift() const { return drifts[at_sight]; }
  void take(const FlightTrace& flight, const std::vector<TrialMoment>& moments) {
    for (std::size_t i = 0; i < sights_m.size(); ++i)
      drifts[i].add(understory::drifts(flight, moments, sights_m[i]));
    while (velocity.size() < 60) velocity.push_back({0.1 * static_cast<double>(velocity.size()) + 0.05});
    for (const TrialMoment& moment : moments) {
      const double since_s = moment.t_s() - flight.release_s();
      const auto bin = static_cast<std::size_t>(std::max(0.0, since_s) / 0.1);
      if (since_s < 0 || bin >= velocity.size()) continue;
      velocity[bin].squared_sum += moment.error().segment<3>(velocity_block).squaredNorm();
      ++velocity[bin].count;
    }
  }
};

/// A sample of each variant over the flights in one air; of the others an empty one.
std::vector<DriftSample> sampled(const Air& air, int flights, const std::vector<std::size_t>& rows) {
  std::vector<DriftSample> samples(variants.size());
  measure_flights(
      flights, [&](int i) { return forest_in(air, drift_seed + static_cast<std::uint64_t>(i)); }, 3.0,
      [&](int number, const FlightTrace& flight) {
        const Sightings seen = sightings(flight, {10.1, 5.0});
        for (const std::size_t row : rows) {
          TrialConfig config = trial_of(flight, drift_sensor_seed + static_cast<std::uint64_t>(number));
          config.sightings = &seen;
          variants[row].change(config);
          samples[row].take(flight, run_trial(flight, config));
        }
      });
  return samples;
}

std::string cell(const DriftSample& sample) {
  const DriftTally& drift = sample.drift();
  return fmt::format("{:.2f} / {:.2f} ({:.2f}, {:.2f})", drift.quantile_m(), drift.across_quantile_m(),
                     drift.rms_m(), drift.stated_rms_m());
}

constexpr const char* passing_label = "drift at passing, 95th percentile (m)";

std::string sight_picture(const DriftSample& calm, const DriftSample& turbulent) {
  LinePlot plot{"Drift over the way to the obstacle", "detected ahead (m)", passing_label};
  const auto series = [&](const std::string& name, const DriftSample& sample) {
    Series one{name, sights_m};
    for (const DriftTally& tally : sample.drifts) one.y.push_back(tally.quantile_m());
    one.mark = Mark::line_and_dots;
    return one;
  };
  plot.series = {series("calm, default", calm), series("3 m/s and turbulence, windy preset", turbulent)};
  return to_svg({plot});
}

constexpr std::size_t over_wind[] = {row_default, row_windy, row_second, row_gps};

std::string wind_picture(const std::vector<std::pair<double, std::vector<DriftSample>>>& by_wind) {
  LinePlot plot{"Drift over 10 m against wind with its turbulence", "wind across (m/s)", passing_label};
  for (const std::size_t row : over_wind) {
    std::string name = variants[row].name;
    std::erase(name, '*');
    plot.series.push_back(plotted(
        name, by_wind, [](const auto& wind) { return wind.first; },
        [row](const auto& wind) { return wind.second[row].drift().quantile_m(); }, Mark::line_and_dots));
  }
  return to_svg({plot});
}

std::string second_depth_picture(const std::vector<DriftSample>& turbulent) {
  LinePlot plot{"Waking in a wind of 3 m/s with turbulence", "since the release (s)",
                "error of the ground velocity, rms (m/s)"};
  std::size_t row = row_unknown;
  for (const char* name : {"nothing known of the ground", "obstacles seen at a second depth", "GPS"})
    plot.series.push_back(
        plotted(name, turbulent[row++].velocity, &VelocityError::since_release_s, &VelocityError::rms_mps));
  return to_svg({plot});
}

}  // namespace

Section drift_section(int flights) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < variants.size(); ++row) rows.push_back(row);
  const std::vector<std::size_t> few(std::begin(over_wind), std::end(over_wind));
  const std::vector<DriftSample> calm = sampled({}, flights, rows),
                                 steady = sampled({3, false}, flights, rows),
                                 turbulent = sampled({3, true}, flights, rows);
  Section section{"drift"};
  section.blocks.insert({{"flights", fmt::format("{}", flights)}});
  for (const std::size_t row : rows)
    section.row("table", fmt::format("{} | {} | {} | {} | {}", variants[row].name, cell(calm[row]),
                                     cell(steady[row]), cell(turbulent[row]), variants[row].computed));
  section.pictures = {{"drift_wind", wind_picture({{0, calm},
                                                   {1.5, sampled({1.5, true}, flights / 2, few)},
                                                   {3, turbulent},
                                                   {5, sampled({5, true}, flights / 2, few)}})},
                      {"drift_sight", sight_picture(calm[row_default], turbulent[row_windy])},
                      {"second_depth", second_depth_picture(turbulent)}};
  const DriftTally& second = turbulent[row_second].drift();
  section.checks = {
      at_most("drift, calm, no wind states", calm[row_default].drift().quantile_m(), 0.15, "m"),
      at_most("drift, calm, wind states", calm[row_windy].drift().quantile_m(), 0.30, "m"),
      at_most("drift, wind and turbulence, ground velocity known from the launch, second depth",
              second.quantile_m(), 0.60, "m"),
      at_most("drift across the path, the same", second.across_quantile_m(), 0.40, "m"),
      at_most("drift, wind and turbulence, with GPS", turbulent[row_gps].drift().quantile_m(), 0.30, "m"),
      at_least("stated divided by measured drift, started in flight",
               1 / turbulent[row_unknown].drift().over_stated(), 0.8, "")};
  return section;
}

}  // namespace understory
