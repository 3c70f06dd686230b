#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/ellipsoid_fluid.hpp"
#include "tests/validation/sections.hpp"

namespace understory {
namespace {

constexpr double speed_mps = 12;
constexpr double sideslip_attack_rad = 11 * degree;  // level flight's at that speed

/// Forces over dynamic pressure and wing area; moments over these and chord (pitch, nose up) or span (roll,
/// right wing down; yaw, nose left).
struct Coefficients {
  double angle_deg;  ///< the one that is swept
  double lift, drag, side, roll, pitch, yaw;
};

struct Model {
  const char* name;
  std::function<Wrench(const AirState&)> wrench;
  Mark mark;
  int colour;
};

Coefficients coefficients(const Airframe& airframe, const Model& model, double attack_rad,
                          double sideslip_rad) {
  AirState air;
  const double cosine = std::cos(sideslip_rad);
  air.air_velocity_body_mps =
      speed_mps *
      Eigen::Vector3d(std::cos(attack_rad) * cosine, std::sin(sideslip_rad), -std::sin(attack_rad) * cosine);
  const Wrench wrench = model.wrench(air);
  const double force_n = 0.5 * airframe.air_density_kgpm3 * speed_mps * speed_mps * airframe.wing_area_m2;
  const Eigen::Vector3d up(std::sin(attack_rad), 0, std::cos(attack_rad));
  const Eigen::Vector3d force = wrench.force_body_n / force_n;
  const Eigen::Vector3d moment = wrench.moment_body_nm / force_n;
  return {0,
          force.dot(up),
          -force.dot(air.air_velocity_body_mps.normalized()),
          force.y(),
          moment.x() / airframe.span_m,
          -moment.y() / airframe.chord_m,
          moment.z() / airframe.span_m};
}

using Sweep = std::vector<Coefficients>;

Sweep sweep(const Airframe& airframe, const Model& model, bool attack) {
  Sweep all;
  for (double angle = attack ? -10 : 0; angle < (attack ? 90.01 : 30.01); angle += 1) {
    all.push_back(attack ? coefficients(airframe, model, angle * degree, 0)
                         : coefficients(airframe, model, sideslip_attack_rad, angle * degree));
    all.back().angle_deg = angle;
  }
  return all;
}

struct Panel {
  const char* title;
  const char* label;
  double Coefficients::*value;
};

std::string picture(const std::vector<Model>& models, const std::vector<Sweep>& sweeps, const char* x_label,
                    const std::vector<Panel>& panels) {
  std::vector<LinePlot> plots;
  for (const Panel& panel : panels) {
    LinePlot& plot = plots.emplace_back(LinePlot{panel.title, x_label, panel.label});
    for (std::size_t i = 0; i < models.size(); ++i)
      plot.series.push_back(plotted(models[i].name, sweeps[i], &Coefficients::angle_deg, panel.value,
                                    models[i].mark, models[i].colour));
  }
  return to_svg(plots, 2);
}

}  // namespace

Section fluid_section(const Airframe& airframe) {
  Airframe bare = airframe;  // what the shapes alone say, nothing identified
  bare.elevon_lift_factor = bare.elevon_drag_factor = 1;
  bare.body_drag_area_m2 = 0;
  bare.rate_damping_nmspr.setZero();
  EllipsoidCoefficients plate_like;  // a plate square to the flow has a drag coefficient of 2, along it none
  plate_like.blunt_drag = 1;
  plate_like.slender_drag = 0;
  const EllipsoidFluid defaults(airframe, {}), like(airframe, plate_like);
  const std::vector<Model> models{
      {"flat plates, same geometry", [&](const AirState& air) { return aerodynamic_wrench(bare, air); },
       Mark::line, 0},
      {"identified model", [&](const AirState& air) { return aerodynamic_wrench(airframe, air); },
       Mark::dashes, 2},
      {"MuJoCo, its defaults", [&](const AirState& air) { return defaults.wrench(air); }, Mark::line, 1},
      {"MuJoCo, drag of a plate", [&](const AirState& air) { return like.wrench(air); }, Mark::dashes, 3}};
  std::vector<Sweep> attacks, slips;
  for (const Model& model : models) {
    attacks.push_back(sweep(airframe, model, true));
    slips.push_back(sweep(airframe, model, false));
  }
  double lift_difference = 0;
  for (std::size_t i = 0; i < attacks[0].size(); ++i)
    if (attacks[0][i].angle_deg >= 10)
      lift_difference = std::max(lift_difference, std::abs(attacks[0][i].lift - attacks[2][i].lift));

  Section section{"fluid"};
  for (const double attack : {5.0, 10.0, 20.0, 30.0, 45.0, 90.0}) {
    std::string row = fmt::format("{:g}", attack);
    for (const std::size_t model : {0u, 2u, 3u}) {
      const Coefficients at = coefficients(airframe, models[model], attack * degree, 0);
      row += fmt::format(" | {:.2f} / {:.2f} / {:+.2f}", at.lift, at.drag, at.pitch);
    }
    section.row("table", row);
  }
  const double pressure_area = 0.5 * airframe.air_density_kgpm3 * 12.27 * 12.27 * airframe.wing_area_m2;
  section.blocks.insert(
      {{"lift", fmt::format("{:.3f}", lift_difference)},
       {"thrust",
        fmt::format("{:.0f}", coefficients(airframe, models[2], 11 * degree, 0).drag * pressure_area)}});
  section.pictures = {
      {"fluid_attack",
       picture(models, attacks, "angle of attack (deg)",
               {{"Lift", "lift coefficient", &Coefficients::lift},
                {"Drag", "drag coefficient", &Coefficients::drag},
                {"Pitching moment, nose up", "moment coefficient (chord)", &Coefficients::pitch}})},
      {"fluid_sideslip",
       picture(models, slips, "sideslip, drifting left (deg)",
               {{"Side force, to the left", "side force coefficient", &Coefficients::side},
                {"Rolling moment, right wing down", "moment coefficient (span)", &Coefficients::roll},
                {"Yawing moment, nose left", "moment coefficient (span)", &Coefficients::yaw}})}};
  section.checks = {
      at_most("lift coefficient, plates less MuJoCo's ellipsoids, 10 to 90 deg", lift_difference, 0.05, "")};
  return section;
}

}  // namespace understory
