#pragma once

#include "planning/airframe.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "sim/scene/world.hpp"

namespace understory {

/// Coefficients of MuJoCo's fluid model, `fluidcoef` (docs/sources.md [7]), with MuJoCo's defaults.
struct EllipsoidCoefficients {
  double blunt_drag = 0.5;
  double slender_drag = 0.25;
  double angular_drag = 1.5;
  double kutta_lift = 1.0;
  double magnus_lift = 1.0;
};

/// The delta wing's wing, elevons and winglets as flat ellipsoids in MuJoCo's own fluid, for comparison with
/// aerodynamic_wrench: the same areas, places and proportions, air of the airframe's density without
/// viscosity. It has no body drag and no identified damping; thrust is not read.
class EllipsoidFluid {
 public:
  EllipsoidFluid(const Airframe& airframe, const EllipsoidCoefficients& coefficients);
  /// At the centre of mass, body axes, as aerodynamic_wrench has it.
  Wrench wrench(const AirState& air) const;

 private:
  ModelPointer model_;
  DataPointer data_;
};

}  // namespace understory
