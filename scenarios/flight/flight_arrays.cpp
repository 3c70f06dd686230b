#include "scenarios/flight/flight_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "scenarios/flight/clearance.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

/// What a page holds at most.
struct Detail {
  std::size_t moments, plans, plan_points, hits, map_points;
  std::size_t obstacles;  ///< those nearest to where the flight ended
  double from_end_s;      ///< plans, hits and points of the map before are left out
  bool is_whole;          ///< has all charts, and all of the map evenly
};
constexpr Detail everything{4800, 3600, 11, 20'000, 20'000, 4000, 1e9, true};  // below 3 MB in base64
constexpr Detail compact{150, 40, 8, 150, 240, 200, 2, false};                 // below 30 kB in base64

constexpr double farthest_shown_m = 5;  // of clearances: beyond it nothing is near
constexpr double degrees = 57.29577951308232;

// ---- decimation ----

/// One of how many is kept so that at most `maximum` are.
std::size_t one_of(std::size_t count, std::size_t maximum) {
  return std::max<std::size_t>(1, (count + maximum - 1) / maximum);
}

/// Every `every`-th, and the last.
template <typename T>
std::vector<T> decimated(const std::vector<T>& all, std::size_t every) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i % every == 0 || i + 1 == all.size()) kept.push_back(all[i]);
  return kept;
}

/// Farthest that a point of `way` lies from the line through every `every`-th, m.
double decimation_error_m(const std::vector<Eigen::Vector3d>& way, std::size_t every) {
  double maximum_m = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const std::size_t from = i / every * every, to = std::min(from + every, way.size() - 1);
    maximum_m = std::max(maximum_m, segment_distance_m({way[i], way[i]}, {way[from], way[to]}));
  }
  return maximum_m;
}

// ---- arrays ----

void append(std::vector<float>& values, const Eigen::Vector3d& position) {
  for (const double coordinate : position) values.push_back(static_cast<float>(coordinate));
}

void append(std::vector<float>& values, const Eigen::Isometry3d& pose) {
  append(values, Eigen::Vector3d(pose.translation()));
  const Eigen::Quaterniond turn(pose.linear());
  for (const double part : {turn.x(), turn.y(), turn.z(), turn.w()})
    values.push_back(static_cast<float>(part));
}

float shown_m(double clearance_m) { return static_cast<float>(std::min(clearance_m, farthest_shown_m)); }

/// When what a page of this detail shows begins.
std::int64_t shown_from_ns(const FlightLog& log, const Detail& detail) {
  return log.moments.back().t_ns - nanoseconds(detail.from_end_s);
}

float shown_s(std::int64_t t_ns) { return static_cast<float>(seconds(t_ns)); }

void add_moments(const FlightLog& log, const Detail& detail, PageArrays& arrays, Json& decimation) {
  const std::size_t every = one_of(log.moments.size(), detail.moments);
  if (every > 1) {
    std::vector<Eigen::Vector3d> way;
    for (const LogMoment& moment : log.moments) way.push_back(moment.T_world_body.translation());
    decimation.push_back(fmt::format("moments: one of {}; the path is at most {:.3f} m from the full one",
                                     every, decimation_error_m(way, every)));
  }
  const std::vector<LogMoment> moments = decimated(log.moments, every);
  std::vector<float> truth, estimate;
  for (const LogMoment& moment : moments) {
    append(truth, moment.T_world_body);
    append(estimate, moment.T_odometry_body);
  }
  arrays.add("truth", 7, truth);
  arrays.add("estimate", 7, estimate);
  const auto add = [&](const std::string& name, auto value_of) {
    std::vector<float> values;
    for (const LogMoment& moment : moments) values.push_back(static_cast<float>(value_of(moment)));
    arrays.add(name, 1, values);
  };
  using Moment = const LogMoment&;
  add("t", [](Moment m) { return seconds(m.t_ns); });
  add("speed", [](Moment m) { return m.velocity_world_mps.norm(); });
  add("estimated_speed", [](Moment m) { return m.estimated_velocity_mps.norm(); });
  add("height", [](Moment m) { return m.T_world_body.translation().z(); });
  add("estimated_height", [](Moment m) { return m.estimated_altitude_m; });
  add("clearance", [](Moment m) { return shown_m(m.clearance_m); });
  add("bank", [](Moment m) { return degrees * bank_rad(m.T_world_body); });
  add("estimated_bank", [](Moment m) { return degrees * bank_rad(m.T_odometry_body); });
  add("commanded_bank", [](Moment m) { return degrees * m.commanded_bank_rad; });
  if (!detail.is_whole) return;
  add("left_elevon", [](Moment m) { return degrees * m.left_elevon_rad; });
  add("right_elevon", [](Moment m) { return degrees * m.right_elevon_rad; });
  for (const auto& [axis, letter] : {std::pair(0, 'x'), {1, 'y'}, {2, 'z'}}) {
    add(fmt::format("error_{}", letter), [&](Moment m) { return position_error_m(m)[axis]; });
    add(fmt::format("sigma3_{}", letter), [&](Moment m) { return 3 * m.position_sigma_m[axis]; });
    add(fmt::format("minus_sigma3_{}", letter), [&](Moment m) { return -3 * m.position_sigma_m[axis]; });
  }
}

void add_hits(const FlightLog& log, const Detail& detail, PageArrays& arrays, Json& decimation) {
  const auto recent = std::ranges::lower_bound(log.frames, shown_from_ns(log, detail), {}, &LogFrame::t_ns);
  const auto all = static_cast<std::int64_t>(log.hits_camera.size());
  const std::int64_t first = recent == log.frames.end() ? all : recent->first_hit;
  const auto every = static_cast<std::int64_t>(one_of(static_cast<std::size_t>(all - first), detail.hits));
  if (every > 1) decimation.push_back(fmt::format("hits: one of {}", every));
  std::vector<float> hits, hits_t, frame_t, frame_hits, other_hits;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Obstacle& one : log.obstacles) boxes.push_back(belonging_box(one));
  for (const LogFrame& frame : log.frames) {
    Eigen::AlignedBox3d around;
    std::vector<Eigen::Vector3d> places_world;
    for (std::int64_t hit = 0; hit < frame.hits; ++hit) {
      places_world.push_back(hit_world(log, frame, hit));
      around.extend(places_world.back());
    }
    std::vector<std::size_t> near;  // of a kilometre's obstacles few are near a frame's hits
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (boxes[i].intersects(around)) near.push_back(i);
    int on_obstacles = 0;
    for (std::int64_t hit = 0; hit < frame.hits; ++hit) {
      const Eigen::Vector3d& place_world = places_world[static_cast<std::size_t>(hit)];
      on_obstacles +=
          std::ranges::any_of(near, [&](std::size_t i) { return belongs_to(place_world, log.obstacles[i]); });
      const std::int64_t number = frame.first_hit + hit;
      if (number < first || number % every != 0) continue;
      append(hits, place_world);
      hits_t.push_back(shown_s(frame.t_ns));
    }
    frame_t.push_back(shown_s(frame.t_ns));
    frame_hits.push_back(static_cast<float>(on_obstacles));
    other_hits.push_back(static_cast<float>(frame.hits - on_obstacles));
  }
  const std::size_t every_frame = one_of(frame_t.size(), detail.moments);
  if (every_frame > 1)
    decimation.push_back(fmt::format("detections in the chart: one frame of {}", every_frame));
  arrays.add("hits", 3, hits);
  arrays.add("hits_t", 1, hits_t);
  arrays.add("frame_t", 1, decimated(frame_t, every_frame));
  arrays.add("frame_hits", 1, decimated(frame_hits, every_frame));
  arrays.add("other_hits", 1, decimated(other_hits, every_frame));
}

void add_map(const FlightLog& log, const Detail& detail, PageArrays& arrays, Json& decimation) {
  const std::int64_t end_ns = log.moments.back().t_ns, from_ns = shown_from_ns(log, detail);
  std::vector<LogPoint> shown;
  std::ranges::copy_if(log.points, std::back_inserter(shown),
                       [&](const LogPoint& one) { return one.to_ns >= from_ns; });
  if (!detail.is_whole && shown.size() > detail.map_points) {
    const Eigen::Vector3d end = log.moments.back().T_odometry_body.translation();
    std::ranges::sort(shown, {},
                      [&](const LogPoint& one) { return (one.point.position_world - end).norm(); });
    decimation.push_back(
        fmt::format("points of the map: the {} nearest to the end, of {}", detail.map_points, shown.size()));
    shown.resize(detail.map_points);
    std::ranges::sort(shown, {}, &LogPoint::from_ns);
  }
  const std::size_t every = one_of(shown.size(), detail.map_points);
  if (every > 1) decimation.push_back(fmt::format("points of the map: one of {}", every));
  std::vector<float> positions, from, to;
  for (const LogPoint& one : decimated(shown, every)) {
    append(positions, one.point.position_world);
    from.push_back(shown_s(one.from_ns));
    to.push_back(shown_s(std::min(one.to_ns, end_ns)));
  }
  arrays.add("map_points", 3, positions);
  arrays.add("map_from", 1, from);
  arrays.add("map_to", 1, to);
}

void add_plans(const FlightLog& log, const Detail& detail, PageArrays& arrays, Json& decimation) {
  const std::int64_t from_ns = shown_from_ns(log, detail);
  std::vector<LogPlan> shown;
  std::ranges::copy_if(log.plans, std::back_inserter(shown),
                       [&](const LogPlan& plan) { return plan.t_ns >= from_ns; });
  const std::size_t every = one_of(shown.size(), detail.plans);
  if (every > 1) decimation.push_back(fmt::format("plans: one of {}", every));
  std::vector<float> t, points, clearance, origin_number;
  std::vector<std::uint32_t> start;
  std::vector<std::uint8_t> origin;
  double error_m = 0;
  for (const LogPlan& plan : decimated(shown, every)) {
    const std::size_t every_point = one_of(plan.way_odometry.size(), detail.plan_points - 1);
    error_m = std::max(error_m, decimation_error_m(plan.way_odometry, every_point));
    t.push_back(shown_s(plan.t_ns));
    start.push_back(static_cast<std::uint32_t>(points.size() / 3));
    for (const Eigen::Vector3d& point : decimated(plan.way_odometry, every_point)) append(points, point);
    origin.push_back(static_cast<std::uint8_t>(plan.origin));
    origin_number.push_back(origin.back());
    clearance.push_back(std::isfinite(plan.clearance_m) ? shown_m(plan.clearance_m)
                                                        : std::numeric_limits<float>::quiet_NaN());
  }
  if (!shown.empty())
    decimation.push_back(
        fmt::format("plans: {} points at most; the drawn line is at most {:.3f} m from the plan",
                    detail.plan_points, error_m));
  arrays.add("plan_t", 1, t);
  arrays.add("plan_start", 1, start);
  arrays.add("plan_points", 3, points);
  arrays.add("plan_origin", 1, origin);
  arrays.add("plan_origin_number", 1, origin_number);
  arrays.add("plan_clearance", 1, clearance);
}

/// Of a wall or a box; nothing for what is round. The first two corners differ along its first axis.
std::optional<std::array<Eigen::Vector3d, 8>> corners_of(const Obstacle& obstacle) {
  Eigen::Isometry3d T_world_box = obstacle.T_world_box();
  Eigen::Vector3d half_m = obstacle.half_size_m;
  if (obstacle.kind == ObstacleKind::wall) {
    const Eigen::Vector3d extent = obstacle.to_world - obstacle.from_world;
    T_world_box.linear() =
        Eigen::AngleAxisd(std::atan2(extent.y(), extent.x()), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    half_m = {0.5 * extent.head<2>().norm(), obstacle.radius_m, 0.5 * std::abs(extent.z())};
  } else if (obstacle.kind != ObstacleKind::box) {
    return std::nullopt;
  }
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i)  // along the first axis, then up, then across
    corners[static_cast<std::size_t>(i)] =
        T_world_box * half_m.cwiseProduct(Eigen::Vector3d(i & 1 ? 1 : -1, i & 4 ? 1 : -1, i & 2 ? 1 : -1));
  return corners;
}

void add_obstacles(const FlightLog& log, const FlightStory& story, const Detail& detail, PageArrays& arrays,
                   Json& facts, Json& decimation) {
  const std::vector<Obstacle>& obstacles = log.obstacles;
  std::vector<std::size_t> shown(obstacles.size());
  std::iota(shown.begin(), shown.end(), std::size_t{0});
  if (shown.size() > detail.obstacles) {
    const Eigen::Vector3d end_world = log.moments.back().T_world_body.translation();
    std::ranges::sort(shown, {}, [&](std::size_t i) { return distance_m(end_world, obstacles[i]); });
    shown.resize(detail.obstacles);
    decimation.push_back(
        fmt::format("obstacles: the {} nearest to the end, of {}", shown.size(), obstacles.size()));
  }
  std::vector<float> values, corners;
  std::vector<std::uint8_t> kinds;
  std::vector<std::uint32_t> boxes;
  facts["touched"] = Json();
  for (const std::size_t i : shown) {
    if (story.touched && i == story.touched->obstacle) {
      facts["touched"] = kinds.size();
      facts["touched_name"] = obstacles[i].name;
    }
    if (const auto box = corners_of(obstacles[i])) {
      boxes.push_back(static_cast<std::uint32_t>(kinds.size()));
      for (const Eigen::Vector3d& corner : *box) append(corners, corner);
    }
    // A page draws round obstacles as cylinders: a sphere as one that is nearly as high as wide.
    const bool ball = obstacles[i].kind == ObstacleKind::sphere;
    const Eigen::Vector3d half(0, 0, ball ? 0.8 * obstacles[i].radius_m : 0);
    append(values, obstacles[i].from_world - half);
    append(values, obstacles[i].to_world + half);
    values.push_back(static_cast<float>(obstacles[i].radius_m));
    kinds.push_back(static_cast<std::uint8_t>(obstacles[i].kind));
  }
  arrays.add("obstacles", 7, values);
  arrays.add("obstacle_kinds", 1, kinds);
  arrays.add("box_corners", 24, corners);
  arrays.add("box_numbers", 1, boxes);
  std::vector<float> crowns;
  for (const Obstacle& crown : course_crowns(log.scenario)) {
    append(crowns, crown.from_world);
    append(crowns, crown.to_world);
    crowns.push_back(static_cast<float>(crown.radius_m));
  }
  arrays.add("crowns", 7, crowns);
  facts["obstacle_kinds"] = obstacle_kind_names;
}

void add_aircraft(const AircraftShape& shape, const std::string& touched_part, PageArrays& arrays) {
  std::vector<float> vertices, box;
  std::vector<std::uint16_t> triangles;
  for (const Eigen::Vector3d& vertex : shape.vertices_body) append(vertices, vertex);
  for (const Eigen::Vector3i& face : shape.faces)
    for (const int corner : face) triangles.push_back(static_cast<std::uint16_t>(corner));
  for (const AircraftPart& part : shape.parts) {
    if (part.name != touched_part) continue;
    append(box, part.centre_body);
    append(box, part.half_size_m);
  }
  arrays.add("wing_vertices", 3, vertices);
  arrays.add("wing_triangles", 3, triangles);
  if (!box.empty()) arrays.add("touched_box", 3, box);
  // The swept trail hangs on the two tips.
  if (shape.vertices_body.empty()) return;
  std::vector<float> tips;
  const auto [right, left] = std::ranges::minmax_element(
      shape.vertices_body, {}, [](const Eigen::Vector3d& vertex) { return vertex.y(); });
  append(tips, *left);
  append(tips, *right);
  arrays.add("wing_tips", 3, tips);
}

// ---- charts ----

Json series(const char* name, const char* array, const char* color, const char* time = nullptr) {
  Json json{{"name", name}, {"array", array}, {"color", color}};
  if (time != nullptr) json["time"] = time;
  return json;
}

Json chart(const char* title, const char* unit, Json lines) {
  return {{"title", title},
          {"unit", unit},
          {"series", std::move(lines)},
          {"bands", Json::array()},
          {"limits", Json::array()}};
}

Json charts_of(const Scenario& scenario, const Detail& detail) {
  Json charts = Json::array();
  charts.push_back(
      chart("Speed over ground", "m/s",
            {series("true", "speed", "truth"), series("estimated", "estimated_speed", "estimate")}));
  Json height = chart(
      "Height", "m",
      {series("true", "height", "truth"), series("estimated above ground", "estimated_height", "estimate")});
  height["limits"] = {{{"name", "lower bound"}, {"value", scenario.band.minimum_altitude_m}},
                      {{"name", "upper bound"}, {"value", scenario.band.maximum_altitude_m}}};
  charts.push_back(height);
  Json clearance = chart(
      "Clearance", "m",
      {series("true", "clearance", "truth"), series("of the plan", "plan_clearance", "command", "plan_t")});
  clearance["limits"] = {{{"name", "touch"}, {"value", 0}}};
  charts.push_back(clearance);
  Json plans = chart("Plan in force", "", {series("plan", "plan_origin_number", "command", "plan_t")});
  for (const PlanOrigin origin :
       {PlanOrigin::straight, PlanOrigin::solved, PlanOrigin::kept, PlanOrigin::fallback})
    plans["words"].push_back(word_for(origin));
  charts.push_back(plans);
  charts.push_back(chart("Detections", "per frame",
                         {series("on obstacles", "frame_hits", "truth", "frame_t"),
                          series("elsewhere", "other_hits", "alert", "frame_t")}));
  charts.push_back(chart("Bank", "deg",
                         {series("true", "bank", "truth"), series("estimated", "estimated_bank", "estimate"),
                          series("commanded", "commanded_bank", "command")}));
  if (!detail.is_whole) return charts;
  charts.push_back(chart("Elevons", "deg",
                         {series("left", "left_elevon", "truth"), series("right", "right_elevon", "other")}));
  for (const char* const axis : {"x", "y", "z"}) {
    const std::string words = fmt::format("Error of the odometry, {}", *axis == 'x'   ? "along the course"
                                                                       : *axis == 'y' ? "to the left"
                                                                                      : "upwards");
    const std::string name = fmt::format("error_{}", axis);
    Json error = chart(words.c_str(), "m", {series("estimate less truth", name.c_str(), "estimate")});
    error["bands"] = {{{"name", "3 sigma"},
                       {"lower", fmt::format("minus_sigma3_{}", axis)},
                       {"upper", fmt::format("sigma3_{}", axis)}}};
    charts.push_back(error);
  }
  return charts;
}

}  // namespace

void add_flight(const FlightLog& log, const FlightStory& story, PageDetail of_page, PageArrays& arrays,
                Json& facts) {
  const Detail& detail = of_page == PageDetail::everything ? everything : compact;
  Json decimation = Json::array();
  facts["charts"] = charts_of(log.scenario, detail);
  add_moments(log, detail, arrays, decimation);
  add_hits(log, detail, arrays, decimation);
  add_map(log, detail, arrays, decimation);
  add_plans(log, detail, arrays, decimation);
  add_obstacles(log, story, detail, arrays, facts, decimation);
  add_aircraft(log.aircraft, log.touch.part, arrays);
  facts["decimation"] = std::move(decimation);
}

}  // namespace understory
