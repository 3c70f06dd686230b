#include "sim/scene/world_config.hpp"

#include "perception/field_visitor.hpp"

namespace understory {

void visit_fields(FieldVisitor& visit, WoodsConfig& config) {
  visit("kinds", config.kinds, woods_kinds_names,
        "kind of all trees; mixed: all five; any: drawn from the seed");
  visit("season", config.season, season_names,
        "winter: oaks, beeches and birches have no leaves; any: drawn from the seed, winter once in four");
  visit("lowest_branch_m", config.lowest_branch_m, 0.0, 40.0,
        "Height of the lowest living branches; some trees have them up to half as much higher. 0: they begin "
        "at 0.32 to 0.48 of the tree's height, but not below a height that is drawn from 6 to 8 m.");
  visit("undergrowth", config.undergrowth, -1.0, 1.0,
        "density of ferns and shrubs, 0 to 1; negative: drawn from 0.2 to 1");
  visit("fallen_logs", config.fallen_logs, -1.0, 1000.0,
        "number of fallen logs per hectare; negative: drawn from 0 to 80");
  visit("litter", config.litter, -1.0, 1.0,
        "share of the ground under dead leaves instead of moss; negative: drawn");
  visit("leaf_tone", config.leaf_tone, -1.0, 1.0,
        "colour of the leaves from fresh (0) to dark (1); negative: drawn");
  visit("overcast", config.overcast, -1.0, 1.0,
        "share of the sunlight that clouds block, 1: no patches of sun; negative: drawn");
  visit("haze_m", config.haze_m, 0.0, 10000.0,
        "distance at which haze takes two thirds of the contrast; 0: drawn from 60 to 250");
  visit("sun_elevation_rad", config.sun_elevation_rad, 0.0, 1.5,
        "height of the sun over the horizon; 0: drawn from 0.15 to 1.2");
  visit("leaves_end_flight", config.leaves_end_flight,
        "ends a flight when the wing touches a leaf; otherwise leaves do not stop the aircraft");
}

void visit_fields(FieldVisitor& visit, WorldConfig& config) {
  visit("bark_contrast", config.bark_contrast, 0.0, 1.0,
        "Standard deviation of the bark's brightness divided by its mean (models/textures/README.md).");
  visit("ground_contrast", config.ground_contrast, 0.0, 1.0,
        "standard deviation of the ground's brightness divided by its mean");
  visit("texture_seed", config.texture_seed, std::uint64_t{0}, std::uint64_t{1} << 32,
        "seed of the textures, separate from `seed`: all flights have the same textures");
  visit("scenery", config.scenery, scenery_names,
        "What is drawn: textured cylinders on a plain, or trees with branches and crowns on a forest floor.");
  visit("woods", config.woods);
}

}  // namespace understory
