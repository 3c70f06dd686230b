#include "scenarios/flight/flight_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <opencv2/core/version.hpp>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/program.hpp"

namespace understory {
namespace {

std::uint64_t mixed(std::uint64_t state, std::uint64_t word) {
  std::uint64_t mixed = (state ^ word) + 0x9e3779b97f4a7c15u;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
  return mixed ^ (mixed >> 31);
}

std::uint64_t word_at(const std::byte* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

using Json = nlohmann::ordered_json;

/// JSON has no infinity.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string clearance_text(double clearance_m) {
  return std::isfinite(clearance_m) ? fmt::format("{:.2f} m", clearance_m) : "no obstacles";
}

}  // namespace

void RunDigest::add(std::uint64_t word) { state_ = mixed(state_, word); }

void RunDigest::add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

void RunDigest::add(const Eigen::Isometry3d& pose) {
  for (Eigen::Index column = 0; column < 4; ++column) {
    for (Eigen::Index row = 0; row < 3; ++row) add(pose.matrix()(row, column));
  }
}

void RunDigest::add(std::span<const std::byte> bytes) {
  constexpr std::size_t word_bytes = sizeof(std::uint64_t);
  add(static_cast<std::uint64_t>(bytes.size()));
  // Each word waits for the one before it. Eight chains side by side take a fifth of the time of one.
  std::array<std::uint64_t, 8> chains{1, 2, 3, 4, 5, 6, 7, 8};
  constexpr std::size_t round_bytes = chains.size() * word_bytes;
  std::size_t at = 0;
  for (; at + round_bytes <= bytes.size(); at += round_bytes)
    for (std::size_t chain = 0; chain < chains.size(); ++chain)
      chains[chain] = mixed(chains[chain], word_at(bytes.data() + at + chain * word_bytes));
  for (const std::uint64_t chain : chains) add(chain);
  for (; at < bytes.size(); at += word_bytes) {
    std::array<std::byte, word_bytes> last{};
    std::copy_n(bytes.data() + at, std::min(word_bytes, bytes.size() - at), last.data());
    add(word_at(last.data()));
  }
}

std::string RunDigest::hex() const { return fmt::format("{:016x}", state_); }

const char* const trajectory_columns =
    "t_s,x_m,y_m,z_m,qw,qx,qy,qz,vx_world_mps,vy_world_mps,vz_world_mps,p_radps,q_radps,r_radps,"
    "est_x_m,est_y_m,est_z_m,est_qw,est_qx,est_qy,est_qz,est_vx_world_mps,est_vy_world_mps,est_vz_world_mps,"
    "est_p_radps,est_q_radps,est_r_radps,left_elevon_command_rad,right_elevon_command_rad,thrust_command_n,"
    "left_elevon_rad,right_elevon_rad,thrust_n,clearance_m\n";

bool is_ending(std::string_view word) {
  constexpr std::array all{Outcome::goal, Outcome::collision, Outcome::ground, Outcome::out_of_bounds,
                           Outcome::time};
  return std::ranges::any_of(all, [&](Outcome outcome) { return word == word_for(outcome); });
}

std::string_view word_for(Outcome outcome) {
  switch (outcome) {
    case Outcome::goal:
      return "goal";
    case Outcome::collision:
      return "collision";
    case Outcome::ground:
      return "ground";
    case Outcome::out_of_bounds:
      return "out_of_bounds";
    case Outcome::time:
      return "time";
  }
  return "unknown";
}

std::string to_json(const FlightResult& result) {
  Json json;
  json["outcome"] = word_for(result.outcome);
  json["scenario"] = result.scenario;
  json["seed"] = result.seed;
  json["sensor_seed"] = result.sensor_seed;
  json["detector"] = result.detector;
  json["state_source"] = result.state_source;
  if (!result.touched.empty()) json["touched"] = result.touched;
  json["simulated_s"] = result.simulated_s;
  json["wall_s"] = result.wall_s;
  json["distance_m"] = result.distance_m;
  json["progress_m"] = result.progress_m;
  json["mean_speed_mps"] = result.mean_speed_mps;
  json["minimum_clearance_m"] = number(result.minimum_clearance_m);
  json["estimation"] = {{"position_error_mean_m", result.position_error_mean_m},
                        {"position_error_max_m", result.position_error_max_m},
                        {"position_error_end_m", result.position_error_end_m},
                        {"attitude_error_max_rad", result.attitude_error_max_rad},
                        {"velocity_error_mean_mps", result.velocity_error_mean_mps}};
  json["frames"] = result.frames;
  json["detections"] = result.detections;
  json["remembered_points"] = result.remembered_points;
  const auto put_count = [&](std::string_view name, std::int64_t count) {
    const std::string key(name == "replans" ? "count" : name == "found" ? "searches_found" : name);
    json["replans"][key] = count;
  };
  visit_fields(put_count, result.planner);
  if (!result.points_on_obstacles.empty()) {
    for (const auto& [name, count] : result.points_on_obstacles) json["points_on_obstacles"][name] = count;
  }
  for (const StageTiming& timing : result.timings) {
    json["timings"][timing.stage] = {
        {"count", timing.count},
        {"mean_ms", timing.count > 0 ? 1e3 * timing.total_s / timing.count : 0.0},
        {"maximum_ms", 1e3 * timing.maximum_s},
        {"total_s", timing.total_s}};
  }
  json["versions"] = {{"understory", understory_version}, {"opencv", CV_VERSION}, {"compiler", __VERSION__}};
  if (!result.renderer.empty()) json["versions"]["renderer"] = result.renderer;
  json["digest"] = result.digest;
  return json_text(json, 2) + "\n";
}

std::string to_report(const FlightResult& result) {
  std::string text;
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<18}{}\n", name, value);
  };
  text += fmt::format("{} (scenario {}, seed {}, {}, {})\n", word_for(result.outcome), result.scenario,
                      result.seed, result.detector, result.state_source);
  if (!result.touched.empty()) line("touched", result.touched);
  line("flown", fmt::format("{:.1f} m in {:.2f} s, {:.1f} m/s on average", result.distance_m,
                            result.simulated_s, result.mean_speed_mps));
  line("minimum clearance", clearance_text(result.minimum_clearance_m));
  line("estimator error",
       fmt::format("{:.2f} m on average, {:.2f} m at most, {:.1f} deg at most", result.position_error_mean_m,
                   result.position_error_max_m, result.attitude_error_max_rad * 57.29577951308232));
  line("detections", fmt::format("{} in {} frames, {} points remembered", result.detections, result.frames,
                                 result.remembered_points));
  const PlannerCounts& planner = result.planner;
  line("replans",
       fmt::format("{}: {} straight, {} solved by OMPL, {} kept ({} of OMPL's), {} fallback", planner.replans,
                   planner.straight, planner.solved, planner.kept, planner.kept_ompl, planner.fallback));
  line("obstacle ahead", fmt::format("in {} replans, {} of them flown on OMPL's answer",
                                     planner.obstacle_ahead, planner.obstacle_ahead_ompl));
  line("real-time factor",
       fmt::format("{:.2f} ({:.1f} s of wall time)",
                   result.wall_s > 0 ? result.simulated_s / result.wall_s : 0.0, result.wall_s));
  line("digest", result.digest);
  return text;
}

}  // namespace understory
