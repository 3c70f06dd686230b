#pragma once

#include "tests/validation/flight_record.hpp"
#include "tests/validation/page.hpp"

namespace understory {

/// The sections of docs/flight_model.md: the simulated delta wing beside what is known of the real one.
Section trim_section(const Airframe& airframe);
Section modes_section(const Airframe& airframe);
Section turn_section(const Airframe& airframe);
Section glide_section(const Airframe& airframe);
Section roll_section(const FreeFlight& air, const Airframe& airframe);
Section dodge_section(const FreeFlight& air, const Airframe& airframe);
/// The real left jog's inputs, open loop, and what of the airframe they tell.
Section replay_section(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record);
/// The real left jog's path under the path follower.
Section tracking_section(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record);
/// MuJoCo's own fluid model beside the flat plates.
Section fluid_section(const Airframe& airframe);

/// The sections of docs/estimator.md: is the filter's uncertainty true, and how far does the map drift. Some
/// 900 flights without a picture.

/// Calm air, sensors whose noise is exactly what the filter is told: whether its uncertainty is true.
Section calm_consistency_section(int flights);
/// The windy preset in 3 m/s of wind and Dryden turbulence.
Section turbulent_consistency_section(int flights);
/// The default filter on nominal, consumer and rough sensors, a section each.
std::vector<Section> graded_consistency_sections(int flights);
/// By how much the place of a remembered obstacle is off when it is passed: each switch of the filter as a
/// row, in three airs, beside what was computed before [15]; against sight, wind and sensors; and what
/// obstacles seen at a second depth bring. `flights` of each air.
Section drift_section(int flights);

/// docs/model_mismatch.md: how often the aircraft still arrives, and how far its map drifts, where it is not
/// the one that the stack's model describes.
std::vector<Section> mismatch_sections();

/// docs/limits.md: kilometres between crashes over speed and density, beside what theory says. From the rows
/// of `understory campaign limits` in docs/results/limits.
Section limits_section();
/// docs/limits.md: what each property of a detector must be, from rows of requirements.py there.
Section requirements_section();

/// docs/ci.md: how often the gate errs, and after how many flights it knows. From outcomes of real flights.
Section gate_section();

}  // namespace understory
