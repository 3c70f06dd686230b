#include "tests/sim/ellipsoid_fluid.hpp"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace understory {
namespace {

constexpr double thickness_m =
    0.010;  // as thick as a foam plate; it must only be thin compared with its chord

/// The area of an ellipse is pi a b. This factor makes it that of a rectangle.
double semi_axis(double side_m) { return side_m / std::sqrt(std::numbers::pi); }

std::string plate(double x, double y, double z, double size_x, double size_y, double size_z,
                  const EllipsoidCoefficients& c) {
  return fmt::format(
      "<geom type='ellipsoid' pos='{} {} {}' size='{} {} {}' mass='0.01' contype='0' conaffinity='0' "
      "fluidshape='ellipsoid' fluidcoef='{} {} {} {} {}'/>",
      x, y, z, size_x, size_y, size_z, c.blunt_drag, c.slender_drag, c.angular_drag, c.kutta_lift,
      c.magnus_lift);
}

std::string model_xml(const Airframe& airframe, const EllipsoidCoefficients& coefficients) {
  const double thin = 0.5 * thickness_m;
  std::string xml = fmt::format(
      "<mujoco><option density='{}' viscosity='0' gravity='0 0 0'/><compiler "
      "angle='radian'/><worldbody><body><freejoint/>",
      airframe.air_density_kgpm3);
  xml += plate(0, 0, 0, semi_axis(airframe.chord_m), semi_axis(airframe.wing_area_m2 / airframe.chord_m),
               thin, coefficients);
  const double winglet =
      semi_axis(std::sqrt(airframe.winglet_area_m2));  // square: the records give the area alone
  for (const double side : {1.0, -1.0}) {
    xml += plate(airframe.winglet_x_m, side * airframe.winglet_y_m, airframe.winglet_z_m, winglet, thin,
                 winglet, coefficients);
  }
  for (const double side : {1.0, -1.0}) {  // left first: the order of qpos
    xml += fmt::format("<body pos='{} {} 0'><joint type='hinge' axis='0 1 0'/>", airframe.elevon_hinge_x_m,
                       side * airframe.elevon_y_m);
    xml += plate(-0.5 * airframe.elevon_chord_m, 0, 0, semi_axis(airframe.elevon_chord_m),
                 semi_axis(airframe.elevon_area_m2 / airframe.elevon_chord_m), thin, coefficients) +
           "</body>";
  }
  return xml + "</body></worldbody></mujoco>";
}

// MuJoCo's own handlers write a log file and wait for Enter.
[[noreturn]] void raise_error(const char* message) {
  throw SimulationError(std::string("MuJoCo: ") + message);
}

void require_room(int failure) {
  if (failure != 0) throw std::runtime_error("MuJoCo: no room for plates.xml in its table of files");
}

}  // namespace

EllipsoidFluid::EllipsoidFluid(const Airframe& airframe, const EllipsoidCoefficients& coefficients) {
  mju_user_error = raise_error;
  mju_user_warning = raise_error;
  const std::string xml = model_xml(airframe, coefficients);
  const std::unique_ptr<mjVFS> files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  require_room(mj_makeEmptyFileVFS(files.get(), "plates.xml", static_cast<int>(xml.size())));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char message[1000] = "";
  model_.reset(mj_loadXML("plates.xml", files.get(), message, sizeof message));
  mj_deleteVFS(files.get());
  if (!model_) throw std::runtime_error(std::string("MuJoCo refuses the ellipsoid plates: ") + message);
  data_.reset(mj_makeData(model_.get()));
}

Wrench EllipsoidFluid::wrench(const AirState& air) const {
  mjData* data = data_.get();
  mj_resetData(model_.get(), data);
  // Elevons: positive trailing edge up. The surface points backwards from its hinge, so that a turn about +y
  // (left) lifts its trailing edge.
  data->qpos[7] = air.left_elevon_rad;
  data->qpos[8] = air.right_elevon_rad;
  Eigen::Map<Eigen::Vector3d>(data->qvel) = air.air_velocity_body_mps;  // attitude 1: world and body agree
  Eigen::Map<Eigen::Vector3d>(data->qvel + 3) = air.angular_rate_body_radps;
  // The free joint's reference is the body's origin, and the centre of mass of the plates lies behind it:
  // velocities and forces here are those at the origin, the aircraft's own centre of mass.
  mj_fwdPosition(model_.get(), data);
  mj_fwdVelocity(model_.get(), data);
  return {Eigen::Map<const Eigen::Vector3d>(data->qfrc_passive),
          Eigen::Map<const Eigen::Vector3d>(data->qfrc_passive + 3)};
}

}  // namespace understory
