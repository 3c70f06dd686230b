// A detector of one's own: matches small patches on strong upright edges at one disparity, with OpenCV.
#include <cmath>
#include <opencv2/imgproc.hpp>

#include <opencv2/core.hpp>

#include "scenarios/scenario/plugin.hpp"

namespace {

using namespace understory;

struct EdgeConfig {
  double depth_m = 10;
  int minimum_edge = 220;
  double maximum_difference = 14;
};

template <typename Visitor>
void visit_fields(Visitor& visit, EdgeConfig& config) {
  visit("depth_m", config.depth_m, 2.0, 40.0, "depth at which edges are compared");
  visit("minimum_edge", config.minimum_edge, 1, 2000, "smallest Sobel response along the rows of an edge");
  visit("maximum_difference", config.maximum_difference, 0.0, 255.0,
        "largest mean difference of gray levels");
}

class EdgeDetector : public ObstacleDetector {
 public:
  EdgeDetector(const StereoRig& rig, const EdgeConfig& config) : rig_(rig), config_(config) {}

  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    hits_.clear();
    const int disparity_px = static_cast<int>(std::lround(rig_.disparity_px(config_.depth_m)));
    cv::Sobel(frame.left, edges_, CV_16S, 1, 0);
    for (int row = 0; row + size_px <= rig_.height_px * 4 / 5; row += size_px)
      for (int column = std::max(0, disparity_px); column + size_px <= rig_.width_px; column += size_px) {
        const cv::Rect here(column, row, size_px, size_px),
            there(column - disparity_px, row, size_px, size_px);
        double strongest = 0;
        cv::minMaxLoc(cv::abs(edges_(here)), nullptr, &strongest);
        const double difference =
            cv::norm(frame.left(here), frame.right(there), cv::NORM_L1) / (size_px * size_px);
        if (strongest < config_.minimum_edge || difference > config_.maximum_difference) continue;
        StereoHit& hit = hits_.emplace_back();
        hit.position_camera = point(column + size_px / 2, row + size_px / 2);
        hit.column_px = column, hit.row_px = row;
        hit.disparity_px = disparity_px;
      }
    return hits_;
  }

 private:
  static constexpr int size_px = 6;
  Eigen::Vector3d point(double column, double row) const {
    return config_.depth_m * Eigen::Vector3d((column - rig_.center_left_x_px) / rig_.focal_px,
                                             (row - rig_.center_y_px) / rig_.focal_px, 1);
  }
  StereoRig rig_;
  EdgeConfig config_;
  cv::Mat edges_;
  std::vector<StereoHit> hits_;
};

}  // namespace

UNDERSTORY_PLUGIN(parts) {
  parts.detectors.add({.name = "edges",
                       .meaning = "patches on upright edges that match at one depth",
                       .make =
                           [](const FlightContext& context) {
                             return std::make_unique<EdgeDetector>(context.rig.rig,
                                                                   own_config<EdgeConfig>(context));
                           }},
                      EdgeConfig{});
}
