#include "scenarios/evaluation/vision_tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

constexpr double response_bin_m = 0.5, response_reach_m = 30;
constexpr DepthInterval any_depth{0.001, 65.535};

/// The bin of `edges` that `value` lies in, as "02 1 to 2 m": numbered, so that names sort.
std::string bin_name(double value, const std::vector<double>& edges, const char* unit) {
  const auto above = std::ranges::upper_bound(edges, value);
  const auto index = above - edges.begin();
  if (above == edges.begin()) return fmt::format("{:02} below {} {}", index, edges.front(), unit);
  if (above == edges.end()) return fmt::format("{:02} from {} {}", index, edges.back(), unit);
  return fmt::format("{:02} {} to {} {}", index, *(above - 1), *above, unit);
}

/// Quarters of the one-pixel interval, in disparity.
std::string distance_name(const ExpectedBlock& block, const DetectionGrid& grid, const StereoRig& rig) {
  const DetectionDepth& depth = grid.depths[block.depth];
  const double off_px = depth.disparity_px - rig.disparity_px(block.mean_depth_m);  // farther: positive
  const int quarter = std::clamp(static_cast<int>(std::floor(2 * off_px)), -2, 1);
  return fmt::format("{}{} {:.2f} to {:.2f} m", block.depth, quarter + 2,
                     rig.depth_m(depth.disparity_px - 0.5 * quarter),
                     rig.depth_m(depth.disparity_px - 0.5 * (quarter + 1)));
}

std::string kind_in(const std::map<int, std::string>& kinds, int object) {
  const auto found = kinds.find(object);
  return found == kinds.end() ? "surface" : found->second;
}

/// Counts a hit that is true or not at one pixel in both precisions.
void count_precision(const StereoHit& hit, bool is_true, const TrueImages& truth, const DetectionGrid& grid,
                     Rates& rates) {
  rates.precision.count(is_true);
  const DepthInterval depths = grid.depths[grid.depth_of(hit)].one_pixel;
  const bool on_obstacle =
      is_true && content_between(truth, hit.column_px, hit.row_px, depths, Surfaces::obstacles).holds();
  if (on_obstacle || !is_true) rates.trunk_precision.count(is_true);
}

struct FrameTally {
  const EvaluationFrame& frame;
  const DetectionGrid& grid;
  const StereoRig& rig;
  const std::map<int, std::string>& kinds;
  const DueBlocks& due;
  VisionTally& to;

  /// The parts that a whole frame belongs to.
  std::array<Rates*, 3> frame_parts() const {
    static const std::vector<double> grays{48, 80, 112, 144, 176}, speeds_mps{2, 8, 9, 10, 11, 12, 13},
        banks_deg{10, 30, 50};
    return {&to.parts["lighting"][bin_name(frame.mean_gray, grays, "gray")],
            &to.parts["speed"][bin_name(frame.speed_mps, speeds_mps, "m/s")],
            &to.parts["bank"][bin_name(frame.bank_rad * 180 / std::numbers::pi, banks_deg, "deg")]};
  }
  /// What a hit's block shows, at the depth that the hit claims where that is true.
  std::string kind_at(const StereoHit& hit, bool is_true) const {
    const BlockContent content =
        content_between(frame.truth, hit.column_px, hit.row_px,
                        is_true ? grid.depths[grid.depth_of(hit)].one_pixel : any_depth, Surfaces::any);
    return content.holds() ? kind_in(kinds, content.object) : "sky";
  }
  std::string lateral_name(int block, double depth_m) const {
    static const std::vector<double> edges_m{1, 2, 3, 4};
    const double column_px = (block % grid.columns + 0.5) * truth_block_px - 0.5;
    return bin_name(std::abs(column_px - rig.center_left_x_px) * depth_m / rig.focal_px, edges_m, "m");
  }

  void add_hits(const std::vector<StereoHit>& hits, const std::array<Rates*, 3>& parts) {
    for (const StereoHit& hit : hits) {
      const auto is_true = true_within(hit, frame.truth, grid);
      for (std::size_t i = 0; i < tolerances_m.size(); ++i) to.rates[i].precision.count(is_true[i]);
      count_precision(hit, is_true[one_pixel], frame.truth, grid, to.rates[one_pixel]);
      to.parts["kind"][kind_at(hit, is_true[one_pixel])].precision.count(is_true[one_pixel]);
      for (Rates* part : parts) part->precision.count(is_true[one_pixel]);
      const int block = grid.block_of(hit);
      if (block >= 0) {
        ++(is_true[one_pixel] ? to.true_positives_at
                              : to.false_positives_at)[static_cast<std::size_t>(block)];
        to.parts["lateral offset"][lateral_name(block, hit.position_camera.z())].precision.count(
            is_true[one_pixel]);
      }
      if (!is_true[one_pixel]) ++to.false_on[lies_on(hit, frame.truth, kinds)];
    }
  }

  void add_expected(const std::vector<bool>& hit_at, const std::array<Rates*, 3>& parts) {
    const auto is_hit = [&](const ExpectedBlock& block) -> bool {
      return hit_at[grid.place(block.depth, block.block)];
    };
    for (std::size_t i = 0; i < tolerances_m.size(); ++i)
      for (const ExpectedBlock& block : due[i]) to.rates[i].recall.count(is_hit(block));
    for (const ExpectedBlock& block : due[one_pixel]) {
      const bool found = is_hit(block);
      to.rates[one_pixel].recall.count(found);
      for (Rates* part : parts) part->recall.count(found);
      to.parts["kind"][kind_in(kinds, block.object)].recall.count(found);
      to.parts["distance"][distance_name(block, grid, rig)].recall.count(found);
      to.parts["lateral offset"][lateral_name(block.block, block.mean_depth_m)].recall.count(found);
      ++to.expected_at[static_cast<std::size_t>(block.block)];
    }
  }

  /// Hits on obstacles at every depth: what the detector answers to.
  void add_response(const std::vector<bool>& hit_at) {
    for (int row = 0; row < grid.rows; ++row)
      for (int column = grid.first_column(0); column < grid.columns; ++column) {
        const BlockContent content = content_between(frame.truth, column * truth_block_px,
                                                     row * truth_block_px, any_depth, Surfaces::obstacles);
        if (content.pixels < truth_block_px * truth_block_px) continue;  // edges have two depths
        const auto bin = static_cast<std::size_t>(content.mean_depth_m / response_bin_m);
        if (bin >= to.response.size()) continue;
        bool found = false;
        for (std::size_t depth = 0; depth < grid.depths.size(); ++depth)
          found = found || hit_at[grid.place(depth, row * grid.columns + column)];
        to.response[bin].count(found);
      }
  }
};

}  // namespace

DueBlocks due_blocks(const TrueImages& truth, const DetectionGrid& grid) {
  DueBlocks due;
  for (std::size_t i = 0; i < tolerances_m.size(); ++i)
    due[i] = expected_blocks(truth, grid, tolerances_m[i]);
  due[one_pixel] = expected_blocks(truth, grid);
  return due;
}

std::array<bool, tolerance_count> true_within(const StereoHit& hit, const TrueImages& truth,
                                              const DetectionGrid& grid) {
  const auto borne_out = [&](DepthInterval depths) {
    return content_between(truth, hit.column_px, hit.row_px, depths, Surfaces::any).holds();
  };
  const double claimed_m = hit.position_camera.z();
  std::array<bool, tolerance_count> is_true{};
  for (std::size_t i = 0; i < tolerances_m.size(); ++i)
    is_true[i] = borne_out({claimed_m - tolerances_m[i], claimed_m + tolerances_m[i]});
  is_true[one_pixel] = borne_out(grid.depths[grid.depth_of(hit)].one_pixel);
  return is_true;
}

void count_one_pixel(const TrueImages& truth, const DetectionGrid& grid,
                     const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits,
                     Rates& rates) {
  for (const StereoHit& hit : hits) {
    const DepthInterval depths = grid.depths[grid.depth_of(hit)].one_pixel;
    count_precision(hit, content_between(truth, hit.column_px, hit.row_px, depths, Surfaces::any).holds(),
                    truth, grid, rates);
  }
  const std::vector<bool> hit_at = grid.places_hit(hits);
  for (const ExpectedBlock& block : expected)
    rates.recall.count(hit_at[grid.place(block.depth, block.block)]);
}

std::string lies_on(const StereoHit& hit, const TrueImages& truth, const std::map<int, std::string>& kinds) {
  constexpr double jump_m = 1.0;
  const BlockContent all = content_between(truth, hit.column_px, hit.row_px, any_depth, Surfaces::any);
  if (!all.holds()) return "sky";
  const BlockContent obstacle =
      content_between(truth, hit.column_px, hit.row_px, any_depth, Surfaces::obstacles);
  const BlockContent beyond = content_between(truth, hit.column_px, hit.row_px,
                                              {obstacle.mean_depth_m + jump_m, 65.5}, Surfaces::any);
  const bool sky_too = all.pixels <= truth_block_px * truth_block_px - minimum_true_pixels;
  if (obstacle.holds() && (beyond.holds() || sky_too)) return "edge of " + kind_in(kinds, obstacle.object);
  if (!obstacle.holds()) return kind_in(kinds, all.object);
  return kind_in(kinds, obstacle.object) +
         (obstacle.mean_depth_m < hit.position_camera.z() ? ", nearer" : ", farther");
}

void VisionTally::add(const VisionTally& other) {
  seconds += other.seconds;
  for (std::size_t i = 0; i < tolerance_count; ++i) rates[i].add(other.rates[i]);
  for (const auto& [what, count] : other.false_on) false_on[what] += count;
  for (const auto& [name, bins] : other.parts)
    for (const auto& [bin, part] : bins) parts[name][bin].add(part);
  response.resize(std::max(response.size(), other.response.size()));
  for (std::size_t i = 0; i < other.response.size(); ++i) response[i].add(other.response[i]);
  columns = std::max(columns, other.columns);
  const auto add_map = [](std::vector<std::int64_t>& to, const std::vector<std::int64_t>& from) {
    to.resize(std::max(to.size(), from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) to[i] += from[i];
  };
  add_map(true_positives_at, other.true_positives_at);
  add_map(false_positives_at, other.false_positives_at);
  add_map(expected_at, other.expected_at);
}

double Rates::f_score() const {
  const double p = precision.value(), r = recall.value();
  return p + r > 0 ? 2 * p * r / (p + r) : 0;
}

double VisionTally::false_per_second() const {
  const Share& share = at_one_pixel().precision;
  return seconds > 0 ? static_cast<double>(share.of - share.with) / seconds : 0;
}

void tally(const EvaluationFrame& frame, const DetectionGrid& grid, const StereoRig& rig,
           const std::map<int, std::string>& kinds, const DueBlocks& due, const std::vector<StereoHit>& hits,
           VisionTally& to) {
  to.columns = grid.columns;
  for (auto* map : {&to.true_positives_at, &to.false_positives_at, &to.expected_at})
    map->resize(static_cast<std::size_t>(grid.block_count()));
  to.response.resize(static_cast<std::size_t>(response_reach_m / response_bin_m));
  FrameTally frame_tally{frame, grid, rig, kinds, due, to};
  const auto parts = frame_tally.frame_parts();
  const std::vector<bool> hit_at = grid.places_hit(hits);
  frame_tally.add_hits(hits, parts);
  frame_tally.add_expected(hit_at, parts);
  frame_tally.add_response(hit_at);
}

}  // namespace understory
