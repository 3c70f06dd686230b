#include "perception/io/hit_files.hpp"

#include <fmt/format.h>

#include <iterator>

namespace understory {
namespace {

std::string ply_header(const char* comment, std::size_t count, const char* last_properties) {
  return fmt::format(
      "ply\nformat ascii 1.0\ncomment {}\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nproperty double t_s\nproperty float score\nproperty {}\nend_header\n",
      comment, count, last_properties);
}

std::string ply_point(const Eigen::Vector3d& position, std::int64_t t_ns, double score) {
  return fmt::format("{:.4f} {:.4f} {:.4f} {:.6f} {:.4f}", position.x(), position.y(), position.z(),
                     static_cast<double>(t_ns) * 1e-9, score);
}

}  // namespace

std::string hits_to_csv(const std::vector<FrameHits>& frames) {
  std::string text = "frame,t_ns,x_m,y_m,z_m,row_px,column_px,disparity_px,score,edge_sum,near_m,far_m\n";
  for (const FrameHits& frame : frames)
    for (const StereoHit& hit : frame.hits) {
      const Eigen::Vector3d& p = hit.position_camera;
      fmt::format_to(std::back_inserter(text),
                     "{},{},{:.4f},{:.4f},{:.4f},{},{},{:.2f},{:.6f},{:.0f},{:.4f},{:.4f}\n", frame.frame,
                     frame.t_ns, p.x(), p.y(), p.z(), hit.row_px, hit.column_px, hit.disparity_px, hit.score,
                     hit.edge_sum, hit.depth.near_m, hit.depth.far_m);
    }
  return text;
}

std::string hits_to_ply(const std::vector<FrameHits>& frames) {
  std::size_t count = 0;
  for (const FrameHits& frame : frames) count += frame.hits.size();
  std::string text = ply_header(
      "hits of all frames, each in its own left camera's frame (x right, y down, z forward), metres", count,
      "float edge_sum\nproperty float near_m\nproperty float far_m\nproperty int frame");
  for (const FrameHits& frame : frames)
    for (const StereoHit& hit : frame.hits)
      text += ply_point(hit.position_camera, frame.t_ns, hit.score) +
              fmt::format(" {:.0f} {:.4f} {:.4f} {}\n", hit.edge_sum, hit.depth.near_m, hit.depth.far_m,
                          frame.frame);
  return text;
}

std::string points_to_ply(const std::vector<ObstaclePoint>& points) {
  std::string text = ply_header("remembered points, world frame of the poses they were carried by, metres",
                                points.size(), "float distance_flown_m");
  for (const ObstaclePoint& point : points)
    text += ply_point(point.position_world, point.t_ns, point.score) +
            fmt::format(" {:.3f}\n", point.distance_flown_m);
  return text;
}

}  // namespace understory
