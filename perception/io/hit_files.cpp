#include "perception/io/hit_files.hpp"

#include <array>
#include <cinttypes>
#include <cstdio>

namespace understory {
namespace {

/// printf's rules for one line at the end of `text`.
template <typename... Values>
void append(std::string& text, const char* format, Values... values) {
  std::array<char, 400> line;
  const int length = std::snprintf(line.data(), line.size(), format, values...);
  text.append(line.data(), static_cast<std::size_t>(length));
}

std::string ply_header(const char* comment, std::size_t count, const char* last_properties) {
  std::string text = "ply\nformat ascii 1.0\ncomment " + std::string(comment) + "\n";
  append(text, "element vertex %zu\n", count);
  text += "property float x\nproperty float y\nproperty float z\nproperty double t_s\nproperty float score\n";
  return text + "property " + last_properties + "\nend_header\n";
}

void append_point(std::string& text, const Eigen::Vector3d& position, std::int64_t t_ns, double score) {
  append(text, "%.4f %.4f %.4f %.6f %.4f", position.x(), position.y(), position.z(),
         static_cast<double>(t_ns) * 1e-9, score);
}

}  // namespace

std::string hits_to_csv(const std::vector<FrameHits>& frames) {
  std::string text = "frame,t_ns,x_m,y_m,z_m,row_px,column_px,disparity_px,score,edge_sum,near_m,far_m\n";
  for (const FrameHits& frame : frames) {
    for (const StereoHit& hit : frame.hits) {
      const Eigen::Vector3d& p = hit.position_camera;
      append(text, "%" PRId64 ",%" PRId64 ",%.4f,%.4f,%.4f,%d,%d,%.2f,%.6f,%.0f,%.4f,%.4f\n", frame.frame,
             frame.t_ns, p.x(), p.y(), p.z(), hit.row_px, hit.column_px, hit.disparity_px, hit.score,
             hit.edge_sum, hit.depth.near_m, hit.depth.far_m);
    }
  }
  return text;
}

std::string hits_to_ply(const std::vector<FrameHits>& frames) {
  std::size_t count = 0;
  for (const FrameHits& frame : frames) count += frame.hits.size();
  std::string text = ply_header(
      "hits of all frames, each in its own left camera's frame (x right, y down, z forward), metres", count,
      "float edge_sum\nproperty float near_m\nproperty float far_m\nproperty int frame");
  for (const FrameHits& frame : frames) {
    for (const StereoHit& hit : frame.hits) {
      append_point(text, hit.position_camera, frame.t_ns, hit.score);
      append(text, " %.0f %.4f %.4f %" PRId64 "\n", hit.edge_sum, hit.depth.near_m, hit.depth.far_m,
             frame.frame);
    }
  }
  return text;
}

std::string points_to_ply(const std::vector<ObstaclePoint>& points) {
  std::string text = ply_header("remembered points, world frame of the poses they were carried by, metres",
                                points.size(), "float distance_flown_m");
  for (const ObstaclePoint& point : points) {
    append_point(text, point.position_world, point.t_ns, point.score);
    append(text, " %.3f\n", point.distance_flown_m);
  }
  return text;
}

}  // namespace understory
