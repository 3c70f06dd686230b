#include "scenarios/evaluation/evaluation_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <set>
#include <stdexcept>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/image_file.hpp"
#include "perception/io/image_sequence.hpp"
#include "perception/io/text_file.hpp"
#include "perception/io/text_table.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// A 16-bit image of the rig's size: depth in millimetres, numbers of objects.
cv::Mat read_16_bit_image(const fs::path& file, const StereoRig& rig) {
  const cv::Mat image = read_gray_image(file, CV_16U);
  if (image.size() != cv::Size(rig.width_px, rig.height_px))
    throw std::runtime_error(
        fmt::format("{}: must be a 16-bit gray image of {}x{}", file.string(), rig.width_px, rig.height_px));
  return image;
}

std::vector<TimedPose> poses_where_there(const fs::path& file) {
  return fs::exists(file) ? read_poses(file) : std::vector<TimedPose>();
}

/// From the poses 10 ms before and after.
double speed_at(const std::vector<TimedPose>& poses, std::int64_t t_ns) {
  constexpr std::int64_t beside_ns = 10'000'000;
  const std::int64_t from_ns = std::max(t_ns - beside_ns, poses.front().t_ns);
  const std::int64_t to_ns = std::min(t_ns + beside_ns, poses.back().t_ns);
  const auto from = pose_at(poses, from_ns), to = pose_at(poses, to_ns);
  if (!from || !to || to_ns <= from_ns) return 0;
  return (to->translation() - from->translation()).norm() / (1e-9 * static_cast<double>(to_ns - from_ns));
}

/// What perception's readers refuse is bad input to this program. Threads read side by side, so that standard
/// error cannot be kept quiet here (evaluate() does it for all of them).
template <typename Read>
auto bad_input_where_refused(Read&& read) {
  try {
    return read();
  } catch (const MachineError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw ScenarioError(error.what());
  }
}

}  // namespace

std::vector<RecordedObject> parse_recorded_objects(const std::string& text, const std::string& name) {
  constexpr const char* expected = "expected 'number,name,kind,from_x,from_y,from_z,to_x,to_y,to_z,radius'";
  std::vector<RecordedObject> objects;
  std::map<int, std::pair<std::string, std::string>> names;
  std::set<std::vector<std::string>> pieces;
  constexpr std::array columns{Column{"number"},      Column{"name"},        Column{"kind"},
                               Column{"from_x", "m"}, Column{"from_y", "m"}, Column{"from_z", "m"},
                               Column{"to_x", "m"},   Column{"to_y", "m"},   Column{"to_z", "m"},
                               Column{"radius", "m"}};
  for (const TableLine& line : named_table(text, CellsParted::by_commas, name, columns).lines) {
    if (line.cells.size() != 10) fail_at_line(name, line.number, expected);
    const auto number = [&](std::size_t cell) {
      const auto value = number_in(line.cells[cell]);
      if (!value) fail_at_line(name, line.number, expected);
      return *value;
    };
    RecordedObject object;
    const auto given = nanoseconds_in(line.cells[0]);  // a whole number from 0
    if (!given || *given < 1 || *given > 65535) fail_at_line(name, line.number, expected);
    object.number = static_cast<int>(*given);
    object.name = line.cells[1];
    object.kind = line.cells[2];
    // An object of several pieces has a line for each, and no piece twice.
    if (!pieces.emplace(line.cells.begin(), line.cells.end()).second)
      fail_at_line(name, line.number, "this line stands above already");
    const auto [before, added] = names.try_emplace(object.number, object.name, object.kind);
    if (!added && before->second != std::pair(object.name, object.kind))
      fail_at_line(name, line.number, "this number belongs to another object above");
    object.from_world = {number(3), number(4), number(5)};
    object.to_world = {number(6), number(7), number(8)};
    object.radius_m = number(9);
    if (object.radius_m < 0) fail_at_line(name, line.number, "the radius must not be negative");
    objects.push_back(object);
  }
  return objects;
}

EvaluationRecording::EvaluationRecording(const fs::path& folder, const CalibrationOptions& options) {
  bad_input_where_refused([&] {
    sequence_ = euroc_sequence(folder);
    folder_ = *euroc_folder(folder);
    camera_ = read_calibrated_rig(folder, options);
    if (const std::string rig = rig_named_in(folder); !rig.empty())
      camera_.rig.name = rig;  // else the folder's
    true_poses_ = poses_where_there(folder_ / "state_groundtruth_estimate0/data.csv");
    if (true_poses_.empty()) true_poses_ = poses_where_there(folder_ / "mocap0/data.csv");  // TUM-VI's
    estimates_ = poses_where_there(folder_ / "estimate0/data.csv");
    has_depth_ = fs::exists(folder_ / "depth0/data.csv");
    const fs::path objects = folder_ / "objects0/objects.csv";
    if (fs::exists(objects))
      objects_ = parse_recorded_objects(read_file(objects, maximum_table_bytes), objects.string());
    for (const RecordedObject& object : objects_) {
      soft_.resize(std::max(soft_.size(), static_cast<std::size_t>(object.number) + 1));
      soft_[static_cast<std::size_t>(object.number)] = !object.is_obstacle();
    }
    return 0;
  });
  if (camera_.calibration) rectifier_.emplace(*camera_.calibration, Interpolation::nearest);
}

bool is_same_rig(const StereoRig& one, const StereoRig& other) {
  return one.focal_px == other.focal_px && one.baseline_m == other.baseline_m &&
         one.width_px == other.width_px && one.detection_depth_m == other.detection_depth_m;
}

double EvaluationRecording::duration_s() const {
  if (sequence_.pairs.size() < 2) return 0;
  return 1e-9 * static_cast<double>(sequence_.pairs.back().t_ns - sequence_.pairs.front().t_ns);
}

EvaluationFrame EvaluationRecording::frame(std::size_t index) {
  const StereoFiles& files = sequence_.pairs[index];
  EvaluationFrame frame;
  bad_input_where_refused([&] {
    frame.pair = {files.t_ns, read_gray_image_of_8_or_16_bits(files.left, image_depth_),
                  read_gray_image_of_8_or_16_bits(files.right, image_depth_)};
    const fs::path name = files.left.filename();
    if (has_depth_) {
      frame.truth.depth_mm = read_16_bit_image(folder_ / "depth0/data" / name, rig());
      frame.truth.shared_depth_mm = shared_depth(frame.truth.depth_mm, rig());
    }
    frame.truth.soft = soft_;
    if (has_objects()) frame.truth.objects = read_16_bit_image(folder_ / "objects0/data" / name, rig());
    return 0;
  });
  const cv::Size size = camera_.calibration
                            ? cv::Size(camera_.calibration->width_px, camera_.calibration->height_px)
                            : cv::Size(rig().width_px, rig().height_px);
  for (const auto& [file, image] :
       {std::pair(&files.left, &frame.pair.left), {&files.right, &frame.pair.right}})
    if (image->size() != size)
      throw ScenarioError(fmt::format("{}: must be {}x{} as the calibration says, is {}x{}", file->string(),
                                      size.width, size.height, image->cols, image->rows));
  if (rectifier_) frame.pair = rectifier_->rectify(frame.pair);
  frame.mean_gray = cv::mean(frame.pair.left)[0];
  if (!has_poses()) return frame;
  if (const auto T_world_body = pose_at(true_poses_, files.t_ns)) {
    frame.T_world_camera = *T_world_body * rig().T_body_camera;
    frame.T_odometry_camera = frame.T_world_camera;
    frame.speed_mps = speed_at(true_poses_, files.t_ns);
    frame.bank_rad = std::asin(std::min(1.0, std::abs(frame.T_world_camera->linear()(2, 0))));
  }
  if (estimates_.empty()) return frame;
  frame.T_odometry_camera.reset();
  if (const auto T_odometry_body = pose_at(estimates_, files.t_ns))
    frame.T_odometry_camera = *T_odometry_body * rig().T_body_camera;
  return frame;
}

}  // namespace understory
