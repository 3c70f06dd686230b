#include "tests/validation/tracking_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenarios/report/line_plot.hpp"
#include "tests/validation/path_tracking.hpp"

namespace understory {
namespace {

constexpr double degree = std::numbers::pi / 180;

double mean_speed_mps(const FlightRecord& record) {
  double sum = 0;
  for (const RecordedMoment& moment : record.moments) sum += moment.velocity_body_mps.norm();
  return sum / static_cast<double>(record.moments.size());
}

double angle_of_attack_deg(const Eigen::Vector3d& velocity_body) {
  return std::atan2(-velocity_body.z(), velocity_body.x()) / degree;
}

}  // namespace

Section tracking_section(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record) {
  TrackingConfig config;
  config.flight_model.cruise_speed_mps = mean_speed_mps(record);
  const Replay flown = track(air, airframe, config, record);

  std::vector<double> t, to_path, to_moment, x, y, roll, attack, real_x, real_y, real_roll, real_attack;
  const std::vector<ReplayError> error = errors(flown, record);
  for (std::size_t i = 0; i < flown.size(); ++i) {
    const RecordedMoment& real = record.moments[i];
    t.push_back(real.t_s);
    to_path.push_back(distance_to_path_m(record, flown[i].position_world));
    to_moment.push_back((flown[i].position_world - real.position_world).norm());
    x.push_back(flown[i].position_world.x());
    y.push_back(flown[i].position_world.y());
    real_x.push_back(real.position_world.x());
    real_y.push_back(real.position_world.y());
    real_roll.push_back(real.roll_rad / degree);
    roll.push_back((real.roll_rad + error[i].roll_rad) / degree);
    attack.push_back(angle_of_attack_deg(flown[i].velocity_body_mps));
    real_attack.push_back(angle_of_attack_deg(real.velocity_body_mps));
  }
  const double worst = *std::max_element(to_path.begin(), to_path.end());
  const double worst_moment = *std::max_element(to_moment.begin(), to_moment.end());

  LinePlot path{"Path from above", "forward (m)", "left (m)"};
  path.series = {{"record", real_x, real_y, Mark::line, 7}, {"follower", x, y, Mark::line, 2}};
  path.equal_scale = true;
  LinePlot distance{"Distance from the record", "time (s)", "distance (m)"};
  distance.series = {{"to its path", t, to_path, Mark::line, 2},
                     {"to where it was at that time", t, to_moment, Mark::dashes, 0}};
  distance.references = {{0.40, "asked: 0.40 m to the path"}};
  LinePlot rolls{"Roll, left wing down negative", "time (s)", "roll (deg)"};
  rolls.series = {{"record", t, real_roll, Mark::line, 7}, {"follower", t, roll, Mark::line, 2}};
  LinePlot attacks{"Angle of attack", "time (s)", "angle of attack (deg)"};
  attacks.series = {{"record", t, real_attack, Mark::line, 7}, {"follower", t, attack, Mark::line, 2}};
  attacks.references = {{config.flight_model.maximum_angle_of_attack_rad / degree, "the follower's cap"}};

  Section section;
  section.title = "The real left jog, closed loop";
  section.markdown = fmt::format(
      "`planning/path_follower` takes a bank and a climb. `tests/validation/path_tracking` makes both "
      "from the record's path: the acceleration across it {:.2f} s ahead, and a critically damped return "
      "of {:g} rad/s to where the aircraft should be. From the recorded start, with the true state at 200 "
      "Hz and the record's mean speed ({:.2f} m/s) as cruise speed, the follower stays within {:.2f} m of "
      "the path (height by integrated velocity), and within {:.2f} m of where the real aircraft was at the "
      "same time. It banks less and pulls harder than the real aircraft did, but stays below its cap of "
      "the angle of attack.\n",
      config.lead_s, config.swing_radps, config.flight_model.cruise_speed_mps, worst, worst_moment);
  section.figures = {{"tracking", "The record's path flown by the path follower",
                      to_svg({path, distance, rolls, attacks}, 2)}};
  section.checks = {at_most("follower on the real jog's path", worst, 0.40, "m")};
  return section;
}

}  // namespace understory
