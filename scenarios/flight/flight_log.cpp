#include "scenarios/flight/flight_log.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {

const LogMoment& moment_at(const FlightLog& log, std::int64_t t_ns) {
  const auto after = std::ranges::upper_bound(log.moments, t_ns, {}, &LogMoment::t_ns);
  return after == log.moments.begin() ? log.moments.front() : *(after - 1);
}

Eigen::Vector3d hit_world(const FlightLog& log, const LogFrame& frame, std::int64_t hit) {
  const auto index = static_cast<std::size_t>(frame.first_hit + hit);
  return frame.T_world_body * (log.rig.rig.T_body_camera * log.hits_camera[index]);
}

double bank_rad(const Eigen::Isometry3d& T_world_body) {
  return std::atan2(T_world_body.linear()(2, 1), T_world_body.linear()(2, 2));
}

Eigen::Vector3d position_error_m(const LogMoment& moment) {
  return moment.T_odometry_body.translation() - moment.T_world_body.translation();
}

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view magic = "understory flight log\n";
constexpr int format = 2;
constexpr std::size_t maximum_bytes = std::size_t{1} << 30;  // unpacked

// Steps to which numbers are rounded.
constexpr double metre = 1e-4, turn = 1e-6, speed = 1e-4, rate = 1e-5, force = 1e-4, share = 1e-6, whole = 1;

// ---- which numbers a row holds: visit(number, step) ----

template <typename Visitor>
void visit_vector(Visitor& visit, Eigen::Vector3d& vector, double step) {
  for (double& number : vector) visit(number, step);
}

template <typename Visitor>
void visit_pose(Visitor& visit, Eigen::Isometry3d& pose) {
  Eigen::Vector3d position = pose.translation();
  Eigen::Quaterniond attitude(pose.linear());
  if (attitude.w() < 0) attitude.coeffs() *= -1;
  visit_vector(visit, position, metre);
  for (double& part : attitude.coeffs()) visit(part, turn);
  if constexpr (Visitor::reads) pose = Eigen::Translation3d(position) * attitude.normalized();
}

template <typename Visitor>
void visit_numbers(Visitor& visit, LogMoment& moment) {
  visit(moment.t_ns, whole);
  visit_pose(visit, moment.T_world_body);
  visit_vector(visit, moment.velocity_world_mps, speed);
  visit_vector(visit, moment.angular_rate_body_radps, rate);
  for (double* angle : {&moment.left_elevon_rad, &moment.right_elevon_rad}) visit(*angle, rate);
  visit(moment.thrust_n, force);
  visit(moment.clearance_m, metre);
  visit_pose(visit, moment.T_odometry_body);
  visit_vector(visit, moment.estimated_velocity_mps, speed);
  visit_vector(visit, moment.estimated_rate_body_radps, rate);
  visit(moment.estimated_altitude_m, metre);
  visit_vector(visit, moment.position_sigma_m, metre);
  for (double* angle : {&moment.controls.left_elevon_rad, &moment.controls.right_elevon_rad})
    visit(*angle, rate);
  visit(moment.controls.thrust_n, force);
  visit(moment.commanded_bank_rad, rate);
}

template <typename Visitor>
void visit_numbers(Visitor& visit, LogFrame& frame) {
  visit(frame.t_ns, whole);
  visit(frame.arrival_ns, whole);
  visit_pose(visit, frame.T_world_body);
  visit(frame.first_hit, whole);
  visit(frame.hits, whole);
}

/// A whole number or an enumerator, which a damaged file may have anywhere.
template <typename Visitor, typename Whole>
void visit_whole(Visitor& visit, Whole& field, std::int64_t least, std::int64_t most) {
  auto number = static_cast<std::int64_t>(field);
  visit(number, whole);
  if constexpr (Visitor::reads) field = static_cast<Whole>(std::clamp(number, least, most));
}

template <typename Visitor>
void visit_numbers(Visitor& visit, Eigen::Vector3d& place) {
  visit_vector(visit, place, metre);
}

template <typename Visitor>
void visit_numbers(Visitor& visit, LogPoint& one) {
  visit_vector(visit, one.point.position_world, metre);
  visit(one.point.t_ns, whole);
  visit(one.point.score, share);
  visit(one.point.distance_flown_m, metre);
  visit_whole(visit, one.point.sightings, 0, std::numeric_limits<int>::max());
  // The true place hangs together with the other by the frame's drift, which changes slowly.
  Eigen::Vector3d drift = one.true_position_world - one.point.position_world;
  visit_vector(visit, drift, metre);
  if constexpr (Visitor::reads) one.true_position_world = one.point.position_world + drift;
  visit(one.from_ns, whole);
  visit(one.to_ns, whole);
}

template <typename Visitor>
void visit_numbers(Visitor& visit, LogPlan& plan) {
  visit(plan.t_ns, whole);
  visit_whole(visit, plan.origin, 0, 3);
  visit(plan.clearance_m, metre);
  auto points = static_cast<std::int64_t>(plan.way_odometry.size());
  visit(points, whole);
  if constexpr (Visitor::reads) plan.way_odometry.resize(visit.count(points));
}

template <typename Visitor>
void visit_numbers(Visitor& visit, Obstacle& obstacle) {
  visit_vector(visit, obstacle.from_world, metre);
  visit_vector(visit, obstacle.to_world, metre);
  visit(obstacle.radius_m, metre);
  for (double& part : obstacle.turn_world.coeffs()) visit(part, turn);
  visit_vector(visit, obstacle.half_size_m, metre);
  visit_whole(visit, obstacle.tree, -1, 1'000'000);
  visit_whole(visit, obstacle.kind, 0, static_cast<std::int64_t>(obstacle_kind_names.size()) - 1);
}

template <typename Visitor>
void visit_numbers(Visitor& visit, Eigen::Vector3i& face) {
  for (int& corner : face)
    visit_whole(visit, corner, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}

template <typename Visitor>
void visit_numbers(Visitor& visit, AircraftPart& part) {
  visit_vector(visit, part.centre_body, metre);
  visit_vector(visit, part.half_size_m, metre);
}

// ---- columns of differences, as variable-length integers ----

constexpr std::int64_t infinite = std::numeric_limits<std::int64_t>::min() / 4;

class Writer {
 public:
  static constexpr bool reads = false;

  template <typename Row>
  void table(std::vector<Row>& rows) {
    put(static_cast<std::int64_t>(rows.size()));
    columns_.clear();
    for (Row& row : rows) {
      column_ = 0;
      visit_numbers(*this, row);
    }
    put(static_cast<std::int64_t>(columns_.size()));
    for (const std::vector<std::int64_t>& column : columns_) {
      std::int64_t before = 0;
      for (const std::int64_t number : column) put(number - std::exchange(before, number));
    }
  }
  void operator()(double number, double step) {
    next().push_back(std::isfinite(number) ? std::llround(number / step) : infinite);
  }
  void operator()(std::int64_t number, double) {
    next().push_back(number == still_there_ns ? infinite : number);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::vector<std::int64_t>& next() {
    if (column_ == columns_.size()) columns_.emplace_back();
    return columns_[column_++];
  }
  void put(std::int64_t number) {
    auto rest = (static_cast<std::uint64_t>(number) << 1) ^ static_cast<std::uint64_t>(number >> 63);
    for (; rest >= 0x80; rest >>= 7) bytes_.push_back(static_cast<char>(rest | 0x80));
    bytes_.push_back(static_cast<char>(rest));
  }

  std::string bytes_;
  std::vector<std::vector<std::int64_t>> columns_;
  std::size_t column_ = 0;
};

class Reader {
 public:
  static constexpr bool reads = true;

  Reader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

  template <typename Row>
  void table(std::vector<Row>& rows) {
    const std::size_t row_count = count(take()), column_count = count(take());
    if (column_count > 0 && row_count > rest_.size() / column_count) refuse();
    rows.resize(row_count);
    columns_.assign(column_count, std::vector<std::int64_t>(row_count));
    for (std::vector<std::int64_t>& column : columns_) {
      std::uint64_t before = 0;  // unsigned, since a damaged file may overflow it
      for (std::int64_t& number : column)
        number = static_cast<std::int64_t>(before += static_cast<std::uint64_t>(take()));
    }
    for (row_ = 0; row_ < rows.size(); ++row_) {
      column_ = 0;
      visit_numbers(*this, rows[row_]);
    }
  }
  void operator()(double& number, double step) {
    const std::int64_t steps = next();
    number = steps == infinite ? std::numeric_limits<double>::infinity() : static_cast<double>(steps) * step;
  }
  void operator()(std::int64_t& number, double) {
    const std::int64_t read = next();
    number = read == infinite ? still_there_ns : read;
  }
  /// Refuses more of anything than the file has bytes left for: each number takes one at least.
  std::size_t count(std::int64_t number) const {
    if (number < 0 || static_cast<std::uint64_t>(number) > rest_.size()) refuse();
    return static_cast<std::size_t>(number);
  }
  [[noreturn]] void refuse() const {
    throw ScenarioError(fmt::format("{}: the log of the flight is damaged; fly it again", name_));
  }

 private:
  std::int64_t next() {
    if (column_ >= columns_.size()) refuse();
    return columns_[column_++][row_];
  }
  std::int64_t take() {
    std::uint64_t number = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      if (rest_.empty()) refuse();
      const auto byte = static_cast<unsigned char>(rest_.front());
      rest_.remove_prefix(1);
      number |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return static_cast<std::int64_t>(number >> 1) ^ -static_cast<std::int64_t>(number & 1);
    }
    refuse();
  }

  std::string_view rest_;
  std::string name_;
  std::vector<std::vector<std::int64_t>> columns_;
  std::size_t column_ = 0, row_ = 0;
};

/// All tables, in the file's order.
template <typename Archive>
void visit_tables(Archive& archive, FlightLog& log) {
  archive.table(log.obstacles);
  archive.table(log.aircraft.vertices_body);
  archive.table(log.aircraft.faces);
  archive.table(log.aircraft.parts);
  archive.table(log.moments);
  archive.table(log.frames);
  archive.table(log.hits_camera);
  archive.table(log.points);
  archive.table(log.plans);
  std::vector<Eigen::Vector3d> ways;  // of all plans, one after the other
  if constexpr (!Archive::reads)
    for (const LogPlan& plan : log.plans)
      ways.insert(ways.end(), plan.way_odometry.begin(), plan.way_odometry.end());
  archive.table(ways);
  if constexpr (Archive::reads) {
    std::size_t next = 0;
    for (LogPlan& plan : log.plans) {
      if (plan.way_odometry.size() > ways.size() - next) archive.refuse();
      for (Eigen::Vector3d& place : plan.way_odometry) place = ways[next++];
    }
  }
}

/// What is no column of numbers.
Json texts_of(const FlightLog& log) {
  Json texts{
      {"format", format}, {"scenario", scenario_to_text(log.scenario)}, {"result", to_json(log.result)}};
  texts["launch_ns"] = log.launch_ns ? Json(*log.launch_ns) : Json();
  texts["obstacles"] = Json::array();
  for (const Obstacle& obstacle : log.obstacles) texts["obstacles"].push_back(obstacle.name);
  texts["parts"] = Json::array();
  for (const AircraftPart& part : log.aircraft.parts) texts["parts"].push_back(part.name);
  const Eigen::Vector3d& place = log.touch.position_world;
  texts["touch"] = {{"with", static_cast<int>(log.touch.with)},
                    {"part", log.touch.part},
                    {"place", {place.x(), place.y(), place.z()}}};
  return texts;
}

void take_texts(const Json& texts, const std::string& name, FlightLog& log) {
  log.scenario = scenario_from_text(texts.at("scenario"), name);
  log.result = result_from_json(texts.at("result"), name);
  if (!texts.at("launch_ns").is_null()) log.launch_ns = texts["launch_ns"].get<std::int64_t>();
  const auto take_names = [&](const char* key, auto& things) {
    const Json& names = texts.at(key);
    for (std::size_t i = 0; i < things.size(); ++i) things[i].name = names.at(i);
  };
  take_names("obstacles", log.obstacles);
  take_names("parts", log.aircraft.parts);
  const Json& touch = texts.at("touch");
  const int with = touch.at("with");
  log.touch.with = with == 1 ? Contact::ground : with == 2 ? Contact::obstacle : Contact::none;
  log.touch.part = touch.at("part");
  for (int axis = 0; axis < 3; ++axis) log.touch.position_world[axis] = touch.at("place").at(axis);
}

}  // namespace

std::string to_bytes(const FlightLog& log) {
  FlightLog copy = log;  // the same visitors read and write, and so take what is not const
  Writer writer;
  visit_tables(writer, copy);
  const std::string texts = json_text(texts_of(log));
  const std::string plain = fmt::format("{}\n", texts.size()) + texts + writer.bytes();
  std::string packed(ZSTD_compressBound(plain.size()), '\0');
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 6);
  if (ZSTD_isError(size)) throw MachineError(std::string("zstd: ") + ZSTD_getErrorName(size));
  packed.resize(size);
  return std::string(magic) + packed;
}

FlightLog flight_log_from_bytes(const std::string& bytes, const std::string& name,
                                const std::filesystem::path& models_folder) {
  const auto refuse = [&](const char* what) { throw ScenarioError(fmt::format("{}: {}", name, what)); };
  if (!bytes.starts_with(magic)) refuse("not the log of a flight (flight.log)");
  const std::string_view packed = std::string_view(bytes).substr(magic.size());
  const std::optional<std::string> unzipped = unpacked(packed, maximum_bytes);
  if (!unzipped) refuse("the log of the flight is damaged; fly it again");
  const std::string& plain = *unzipped;
  FlightLog log;
  try {
    const std::size_t line = plain.find('\n');
    const std::size_t length = line == std::string::npos ? plain.size() : std::stoul(plain.substr(0, line));
    if (length > plain.size() - line - 1) refuse("the log of the flight is damaged; fly it again");
    const Json texts = Json::parse(plain.substr(line + 1, length));
    if (texts.at("format") != format) refuse("written by another version of understory; fly it again");
    Reader reader(std::string_view(plain).substr(line + 1 + length), name);
    visit_tables(reader, log);
    take_texts(texts, name, log);
  } catch (const Json::exception&) {
    refuse("the log of the flight is damaged; fly it again");
  } catch (const std::logic_error&) {  // a length that is no number
    refuse("the log of the flight is damaged; fly it again");
  }
  const bool is_whole = !log.moments.empty() && std::ranges::all_of(log.frames, [&](const LogFrame& frame) {
    return frame.first_hit >= 0 && frame.hits >= 0 &&
           static_cast<std::size_t>(frame.first_hit + frame.hits) <= log.hits_camera.size();
  });
  if (!is_whole) refuse("the log of the flight is damaged; fly it again");
  log.rig = rig_of(log.scenario, models_folder);
  return log;
}

}  // namespace understory
