#include "scenarios/flight/flight_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "scenarios/flight/clearance.hpp"

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

double distance_m(const Eigen::Vector3d& point, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0;
  return (from + share * along - point).norm();
}

/// Farthest that a point of `way` lies from the line through every `every`-th, m.
double decimation_error_m(const std::vector<Eigen::Vector3d>& way, std::size_t every) {
  double maximum_m = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const std::size_t from = i / every * every, to = std::min(from + every, way.size() - 1);
    maximum_m = std::max(maximum_m, distance_m(way[i], way[from], way[to]));
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

void add_moments(const FlightTrack& track, const Detail& detail, PageArrays& arrays, Json& decimation) {
  const std::size_t every = one_of(track.moments.size(), detail.moments);
  if (every > 1) {
    std::vector<Eigen::Vector3d> way;
    for (const TrackMoment& moment : track.moments) way.push_back(moment.T_world_true.translation());
    decimation.push_back(fmt::format("moments: one of {}; the path is at most {:.3f} m from the full one",
                                     every, decimation_error_m(way, every)));
  }
  const std::vector<TrackMoment> moments = decimated(track.moments, every);
  std::vector<float> truth, estimate;
  for (const TrackMoment& moment : moments) {
    append(truth, moment.T_world_true);
    append(estimate, moment.T_world_estimated);
  }
  arrays.add("truth", 7, truth);
  arrays.add("estimate", 7, estimate);
  const auto add = [&](const char* name, auto value_of) {
    std::vector<float> values;
    for (const TrackMoment& moment : moments) values.push_back(static_cast<float>(value_of(moment)));
    arrays.add(name, 1, values);
  };
  using Moment = const TrackMoment&;
  add("t", [](Moment m) { return m.t_s; });
  add("speed", [](Moment m) { return m.speed_mps; });
  add("estimated_speed", [](Moment m) { return m.estimated_speed_mps; });
  add("height", [](Moment m) { return m.T_world_true.translation().z(); });
  add("estimated_height", [](Moment m) { return m.estimated_altitude_m; });
  add("clearance", [](Moment m) { return shown_m(m.clearance_m); });
  add("bank", [](Moment m) { return degrees * m.bank_rad; });
  add("estimated_bank", [](Moment m) { return degrees * m.estimated_bank_rad; });
  add("commanded_bank", [](Moment m) { return degrees * m.commanded_bank_rad; });
  if (!detail.is_whole) return;
  add("left_elevon", [](Moment m) { return degrees * m.left_elevon_rad; });
  add("right_elevon", [](Moment m) { return degrees * m.right_elevon_rad; });
  for (const auto& [axis, letter] : {std::pair(0, 'x'), {1, 'y'}, {2, 'z'}}) {
    add(fmt::format("error_{}", letter).c_str(), [&](Moment m) { return m.position_error_world[axis]; });
    add(fmt::format("sigma3_{}", letter).c_str(), [&](Moment m) { return 3 * m.position_sigma_world[axis]; });
    add(fmt::format("minus_sigma3_{}", letter).c_str(),
        [&](Moment m) { return -3 * m.position_sigma_world[axis]; });
  }
}

void add_hits(const FlightTrack& track, const std::vector<Obstacle>& obstacles, const Detail& detail,
              PageArrays& arrays, Json& decimation) {
  const double from_s = track.moments.back().t_s - detail.from_end_s;
  const auto recent = std::ranges::partition_point(
      track.frames, [&](const TrackFrame& frame) { return static_cast<double>(frame.t_ns) * 1e-9 < from_s; });
  const std::size_t first = recent == track.frames.end() ? track.hits_world.size() : recent->first_hit;
  const std::size_t every = one_of(track.hits_world.size() - first, detail.hits);
  if (every > 1) decimation.push_back(fmt::format("hits: one of {}", every));
  std::vector<float> hits, hits_t, frame_t, frame_hits, other_hits;
  for (const TrackFrame& frame : track.frames) {
    const auto t_s = static_cast<float>(static_cast<double>(frame.t_ns) * 1e-9);
    frame_t.push_back(t_s);
    const auto begin = track.hits_world.begin() + static_cast<std::ptrdiff_t>(frame.first_hit);
    const auto on_obstacles = std::count_if(
        begin, begin + static_cast<std::ptrdiff_t>(frame.hits), [&](const Eigen::Vector3d& hit_world) {
          return std::ranges::any_of(obstacles,
                                     [&](const Obstacle& one) { return belongs_to(hit_world, one); });
        });
    frame_hits.push_back(static_cast<float>(on_obstacles));
    other_hits.push_back(static_cast<float>(frame.hits) - frame_hits.back());
    for (std::size_t i = std::max(first, frame.first_hit); i < frame.first_hit + frame.hits; ++i) {
      if (i % every != 0) continue;
      append(hits, track.hits_world[i]);
      hits_t.push_back(t_s);
    }
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

void add_map(const FlightTrack& track, const Detail& detail, PageArrays& arrays, Json& decimation) {
  const double from_s = track.moments.back().t_s - detail.from_end_s;
  std::vector<TrackPoint> shown;
  std::ranges::copy_if(track.points, std::back_inserter(shown),
                       [&](const TrackPoint& point) { return point.to_s >= from_s; });
  if (!detail.is_whole && shown.size() > detail.map_points) {
    const Eigen::Vector3d end_world = track.moments.back().T_world_estimated.translation();
    std::ranges::sort(shown, {},
                      [&](const TrackPoint& point) { return (point.position_world - end_world).norm(); });
    decimation.push_back(
        fmt::format("points of the map: the {} nearest to the end, of {}", detail.map_points, shown.size()));
    shown.resize(detail.map_points);
    std::ranges::sort(shown, {}, &TrackPoint::from_s);
  }
  const std::size_t every = one_of(shown.size(), detail.map_points);
  if (every > 1) decimation.push_back(fmt::format("points of the map: one of {}", every));
  std::vector<float> positions, from, to;
  for (const TrackPoint& point : decimated(shown, every)) {
    append(positions, point.position_world);
    from.push_back(static_cast<float>(point.from_s));
    to.push_back(static_cast<float>(point.to_s));
  }
  arrays.add("map_points", 3, positions);
  arrays.add("map_from", 1, from);
  arrays.add("map_to", 1, to);
}

void add_plans(const FlightTrack& track, const Detail& detail, PageArrays& arrays, Json& decimation) {
  const double from_s = track.moments.back().t_s - detail.from_end_s;
  std::vector<TrackPlan> shown;
  std::ranges::copy_if(track.plans, std::back_inserter(shown),
                       [&](const TrackPlan& plan) { return plan.from_s >= from_s; });
  const std::size_t every = one_of(shown.size(), detail.plans);
  if (every > 1) decimation.push_back(fmt::format("plans: one of {}", every));
  std::vector<float> t, points, clearance, origin_number;
  std::vector<std::uint32_t> start;
  std::vector<std::uint8_t> origin;
  double error_m = 0;
  for (const TrackPlan& plan : decimated(shown, every)) {
    const std::size_t every_point = one_of(plan.way_world.size(), detail.plan_points - 1);
    error_m = std::max(error_m, decimation_error_m(plan.way_world, every_point));
    t.push_back(static_cast<float>(plan.from_s));
    start.push_back(static_cast<std::uint32_t>(points.size() / 3));
    for (const Eigen::Vector3d& point : decimated(plan.way_world, every_point)) append(points, point);
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

void add_obstacles(const Flight& flight, std::optional<std::size_t> touched, const Detail& detail,
                   PageArrays& arrays, Json& facts, Json& decimation) {
  const std::vector<Obstacle>& obstacles = flight.obstacles();
  std::vector<std::size_t> shown(obstacles.size());
  std::iota(shown.begin(), shown.end(), std::size_t{0});
  if (shown.size() > detail.obstacles) {
    const Eigen::Vector3d& end_world = flight.truth().T_world_body.translation();
    std::ranges::sort(shown, {}, [&](std::size_t i) {
      return obstacle_distance_m({end_world, end_world}, obstacles[i]);
    });
    shown.resize(detail.obstacles);
    decimation.push_back(
        fmt::format("obstacles: the {} nearest to the end, of {}", shown.size(), obstacles.size()));
  }
  std::vector<float> values;
  facts["touched"] = Json();
  for (const std::size_t i : shown) {
    if (i == touched) {
      facts["touched"] = values.size() / 7;
      facts["touched_name"] = obstacles[i].name;
    }
    append(values, obstacles[i].from_world);
    append(values, obstacles[i].to_world);
    values.push_back(static_cast<float>(obstacles[i].radius_m));
  }
  arrays.add("obstacles", 7, values);
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

void add_track(const Flight& flight, const FlightTrack& track, const FlightStory& story, PageDetail of_page,
               PageArrays& arrays, Json& facts) {
  const Detail& detail = of_page == PageDetail::everything ? everything : compact;
  Json decimation = Json::array();
  facts["charts"] = charts_of(flight.scenario(), detail);
  add_moments(track, detail, arrays, decimation);
  add_hits(track, flight.obstacles(), detail, arrays, decimation);
  add_map(track, detail, arrays, decimation);
  add_plans(track, detail, arrays, decimation);
  add_obstacles(flight, story.touched, detail, arrays, facts, decimation);
  add_aircraft(flight.aircraft_shape(), story.part, arrays);
  facts["decimation"] = std::move(decimation);
}

}  // namespace understory
