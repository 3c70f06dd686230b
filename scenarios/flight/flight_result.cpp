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
#include "scenarios/output/errors.hpp"
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

std::optional<Outcome> outcome_named(std::string_view word) {
  const auto found = std::ranges::find(outcome_names, word);
  if (found == outcome_names.end()) return {};
  return static_cast<Outcome>(found - outcome_names.begin());
}

std::string to_json(const FlightResult& result) {
  Json json;
  const auto put = [&](std::string_view name, const auto& value, std::string_view) {
    using Value = std::remove_cvref_t<decltype(value)>;
    Json& to = json[std::string(name)];
    if constexpr (std::is_same_v<Value, Outcome>)
      to = word_for(value);
    else if constexpr (std::is_same_v<Value, std::int64_t>)
      to = value < 0 ? Json(nullptr) : Json(value);
    else
      to = value;
  };
  visit_fields(put, result);
  for (const auto& [name, count] : result.points_on_obstacles) json["points_on_obstacles"][name] = count;
  for (const auto& [name, count] : result.planner.own) json["planner_counts"][name] = count;
  for (const StageTiming& timing : result.timings) {
    json["timings"][timing.stage] = {
        {"count", timing.count},
        {"mean_ms", timing.count > 0 ? 1e3 * timing.total_s / timing.count : 0.0},
        {"maximum_ms", 1e3 * timing.maximum_s},
        {"total_s", timing.total_s}};
  }
  json["versions"] = {{"understory", understory_version}, {"opencv", CV_VERSION}, {"compiler", __VERSION__}};
  return json_text(json, 2) + "\n";  // null for infinity, which JSON has not
}

FlightResult result_from_json(const std::string& text, const std::string& name) try {
  const Json json = parse_json(text);
  FlightResult result;
  const auto take = [&](std::string_view key, auto& value, std::string_view) {
    using Value = std::remove_cvref_t<decltype(value)>;
    const Json& from = json.at(std::string(key));
    if constexpr (std::is_same_v<Value, Outcome>) {
      const std::optional<Outcome> outcome = outcome_named(from.get<std::string>());
      if (!outcome)
        throw ScenarioError(
            fmt::format("{}: outcome: must be goal, collision, ground, out_of_bounds or time", name));
      value = *outcome;
    } else if (!from.is_null()) {  // null: the field's own default says nothing
      value = from.get<Value>();
    }
  };
  visit_fields(take, result);
  if (json.contains("points_on_obstacles"))
    for (const auto& [obstacle, count] : json["points_on_obstacles"].items())
      result.points_on_obstacles.emplace_back(obstacle, count.get<std::int64_t>());
  if (json.contains("planner_counts"))
    for (const auto& [count, number] : json["planner_counts"].items())
      result.planner.own.emplace_back(count, number.get<std::int64_t>());
  return result;
} catch (const Json::exception&) {
  throw ScenarioError(fmt::format("{}: not a flight's result of this version", name));
}

std::vector<std::pair<std::string, std::string>> result_lines(const FlightResult& result) {
  std::vector<std::pair<std::string, std::string>> lines;
  const auto line = [&](std::string_view name, std::string value) {
    lines.emplace_back(name, std::move(value));
  };
  line("outcome", std::string(word_for(result.outcome)));
  if (!result.contradiction.empty()) line("contradiction", result.contradiction);
  if (!result.touched.empty()) line("touched", result.touched);
  line("flown", fmt::format("{:.1f} m in {:.2f} s, {:.1f} m/s on average", result.distance_m,
                            result.simulated_s, result.mean_speed_mps));
  if (result.among_obstacles_m > 0)
    line("among obstacles", fmt::format("{:.1f} m of the course", result.among_obstacles_m));
  line("minimum clearance", clearance_text(result.minimum_clearance_m));
  line("estimator error",
       fmt::format("{:.2f} m on average, {:.2f} m at most, {:.1f} deg at most", result.position_error_mean_m,
                   result.position_error_max_m, result.attitude_error_max_rad * 57.29577951308232));
  line("detections", fmt::format("{} in {} frames, {} points remembered", result.detections, result.frames,
                                 result.remembered_points));
  const PlannerCounts& planner = result.planner;
  line("replans",
       fmt::format(
           "{}: {} straight on, {} new manoeuvres, {} kept from the plan before ({} of them manoeuvres), {} "
           "emergency manoeuvres",
           planner.replans, planner.straight, planner.solved, planner.kept, planner.kept_ompl,
           planner.fallback));
  line("obstacle ahead", fmt::format("in {} replans; in {} of them a manoeuvre of the search was flown",
                                     planner.obstacle_ahead, planner.obstacle_ahead_ompl));
  for (const auto& [name, number] : planner.own) {
    std::string words = name;
    std::ranges::replace(words, '_', ' ');
    line(words, fmt::format("{} (a count of the planner's own)", number));
  }
  line("renderer", result.renderer.empty() ? "none: no images" : result.renderer);
  line("digest", result.digest);
  return lines;
}

std::string to_report(const FlightResult& result) {
  std::string text = fmt::format("{} (scenario {}, seed {}, {}, {})\n", word_for(result.outcome),
                                 result.scenario, result.seed, result.detector, result.state_source);
  for (const auto& [name, value] : result_lines(result))
    if (name != "outcome" && name != "renderer") text += fmt::format("  {:<17} {}\n", name, value);
  return text + fmt::format("  {:<18}{:.2f} ({:.1f} s of wall time)\n", "real-time factor",
                            result.wall_s > 0 ? result.simulated_s / result.wall_s : 0.0, result.wall_s);
}

}  // namespace understory
