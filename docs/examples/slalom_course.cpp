// A course of one's own: poles to the left and right of the way by turns.
#include "scenarios/scenario/plugin.hpp"

namespace {

using namespace understory;

struct SlalomConfig {
  double spacing_m = 12;
  double offset_m = 0.6;
};

template <typename Visitor>
void visit_fields(Visitor& visit, SlalomConfig& config) {
  visit("spacing_m", config.spacing_m, 4.0, 100.0, "distance between poles along the course");
  visit("offset_m", config.offset_m, 0.0, 20.0, "distance of each pole from the middle of the course");
}

Planted slalom(const CourseContext& context) {
  const auto& config = own_config<SlalomConfig>(context);
  double side = context.seed % 2 == 0 ? 1 : -1;
  Planted planted;
  for (double x_m = 20; x_m < context.scenario.goal_x_m(); x_m += config.spacing_m, side = -side) {
    Obstacle pole{.name = "pole_" + std::to_string(planted.obstacles.size())};
    pole.from_world = {x_m, side * config.offset_m, 0};
    pole.to_world = pole.from_world + Eigen::Vector3d(0, 0, 9);
    planted.obstacles.push_back(pole);
  }
  return planted;
}

}  // namespace

UNDERSTORY_PLUGIN(parts) {
  parts.courses.add({.name = "slalom", .meaning = "poles left and right by turns", .make = slalom},
                    SlalomConfig{});
}
