#include "tests/validation/glide_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenarios/report/line_plot.hpp"
#include "tests/validation/steady_flight.hpp"

namespace understory {

Section glide_section(const Airframe& airframe) {
  constexpr double degree = std::numbers::pi / 180;
  Series sink{"trimmed, elevons included"}, attack = sink, point_mass{"lift and drag of wing and body alone"};
  point_mass.mark = Mark::dashes;
  double minimum_sink = HUGE_VAL, minimum_sink_speed = 0, best_ratio = 0, best_ratio_speed = 0;
  for (double speed = 7.5; speed < 15.01; speed += 0.1) {
    SteadyFlight given;
    given.airspeed_mps = speed;
    given.climb_angle_rad = -0.5;
    const std::optional<SteadyFlight> glide = steady_flight(airframe, given, Solved::climb_angle);
    if (!glide) continue;
    sink.x.push_back(speed);
    sink.y.push_back(glide->sink_mps());
    attack.x.push_back(speed);
    attack.y.push_back(glide->angle_of_attack_rad / degree);
    const double pressure_area = 0.5 * airframe.air_density_kgpm3 * speed * speed;
    const double sine = std::sin(glide->angle_of_attack_rad), cosine = std::cos(glide->angle_of_attack_rad);
    const double drag_n = pressure_area * (2 * airframe.wing_area_m2 * sine * sine +
                                           airframe.body_drag_area_m2 * cosine * cosine * cosine);
    point_mass.x.push_back(speed);
    point_mass.y.push_back(speed * drag_n / (airframe.mass_kg * airframe.gravity_mps2));
    if (glide->sink_mps() < minimum_sink) {
      minimum_sink = glide->sink_mps();
      minimum_sink_speed = speed;
    }
    const double ratio = 1 / std::tan(-glide->climb_angle_rad);
    if (ratio > best_ratio) {
      best_ratio = ratio;
      best_ratio_speed = speed;
    }
  }
  LinePlot polar{"Glide polar", "airspeed (m/s)", "sink (m/s)"};
  polar.series = {sink, point_mass};
  polar.y_range = AxisRange{0, 15};
  LinePlot attacks{"Angle of attack in the glide", "airspeed (m/s)", "angle of attack (deg)"};
  attacks.series = {attack};
  attacks.references = {{25, "25 deg: a real wing stalls about here"}};
  Section section;
  section.title = "Glide";
  section.markdown = fmt::format(
      "Without thrust. Flat plates and the identified body drag (0.0443 m² along the body) make a poor "
      "glider: the best glide ratio is {:.2f} at {:.1f} m/s, the least sink {:.2f} m/s at {:.1f} m/s. "
      "FACTS has no polar; its thrust in level flight says the same (5.08 N of 6.36 N of weight at 12.27 "
      "m/s: a ratio of 1.25). The drag was identified with the motor running, and a stopped propeller may "
      "drag more or less.\n",
      best_ratio, best_ratio_speed, minimum_sink, minimum_sink_speed);
  section.figures = {{"glide", "Straight glide without thrust", to_svg({polar, attacks}, 2)}};
  return section;
}

}  // namespace understory
