#include "scenarios/detect/rig_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace understory {
namespace {

const cv::Scalar ink(50, 45, 40), pale(215, 212, 208), blue(190, 110, 30), orange(20, 120, 225),
    green(60, 140, 30), red(50, 40, 200), white(255, 255, 255);

enum class Anchor { left, center, right };

void write(cv::Mat& image, const std::string& text, cv::Point2d at, const cv::Scalar& color,
           Anchor anchor = Anchor::left, double size = 0.5) {
  int below = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &below);
  const double shift = anchor == Anchor::left ? 0 : anchor == Anchor::center ? 0.5 : 1;
  at.x -= shift * extent.width;
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, size, color, 1, cv::LINE_AA);
}

/// A polygon laid over the picture as a sheet of coloured glass.
void tint(cv::Mat& image, const std::vector<cv::Point>& corners, const cv::Scalar& color, double opacity) {
  cv::Mat layer = image.clone();
  cv::fillPoly(layer, std::vector<std::vector<cv::Point>>{corners}, color, cv::LINE_AA);
  cv::addWeighted(layer, opacity, image, 1 - opacity, 0, image);
}

/// The ground plan: x to the right of the left camera, z ahead of it, one scale for both.
class TopView {
 public:
  TopView(cv::Mat image, const StereoRig& rig, const RigFigures& figures)
      : image_(std::move(image)), rig_(rig), figures_(figures) {
    const double wide_m = 1.15 * (figures.surface_right_m - figures.surface_left_m) *
                          figures.one_pixel.far_m / figures.detection_depth_m;
    top_m_ = std::max(1.3 * figures.one_pixel.far_m, 0.92 * wide_m * image_.rows / image_.cols);
    bottom_m_ = -0.09 * top_m_;
    px_per_m_ = image_.rows / (top_m_ - bottom_m_);
    const double middle_m = 0.5 * (figures.surface_left_m + figures.surface_right_m);
    left_m_ = middle_m - 0.5 * image_.cols / px_per_m_;
  }

  void draw() {
    draw_grid();
    draw_view(0, rig_.center_left_x_px, blue);
    draw_view(rig_.baseline_m, rig_.center_right_x_px, orange);
    draw_surface();
    draw_camera(0, blue);
    draw_camera(rig_.baseline_m, orange);
    write(image_, "left", place(0, 0) + cv::Point(-14, 18), blue, Anchor::right);
    write(image_, "right", place(rig_.baseline_m, 0) + cv::Point(14, 18), orange);
    write(image_, fmt::format("baseline {:.3f} m", rig_.baseline_m),
          place(0.5 * rig_.baseline_m, 0) + cv::Point(0, 40), ink, Anchor::center);
    cv::rectangle(image_, {0, 0}, {image_.cols - 1, image_.rows - 1}, ink, 1);
  }

 private:
  cv::Point place(double x_m, double z_m) const {
    return {cvRound((x_m - left_m_) * px_per_m_), cvRound((top_m_ - z_m) * px_per_m_)};
  }

  void draw_grid() {
    const double minimum_step_m = 70 / px_per_m_;  // 1, 2 or 5 times a power of ten
    double step_m = std::pow(10, std::floor(std::log10(minimum_step_m)));
    for (const double factor : {2.0, 2.5, 2.0})
      if (step_m < minimum_step_m) step_m *= factor;
    const double right_m = left_m_ + image_.cols / px_per_m_;
    for (double x_m = std::ceil(left_m_ / step_m) * step_m; x_m < right_m; x_m += step_m) {
      cv::line(image_, place(x_m, bottom_m_), place(x_m, top_m_), pale);
      write(image_, fmt::format("{:g} m", std::abs(x_m) < 1e-9 ? 0.0 : x_m),
            {place(x_m, 0).x + 4.0, image_.rows - 8.0}, ink, Anchor::left, 0.42);
    }
    for (double z_m = 0; z_m < top_m_; z_m += step_m) {
      cv::line(image_, place(left_m_, z_m), place(right_m, z_m), pale);
      if (place(0, z_m).y > 20)
        write(image_, fmt::format("{:g} m", z_m), {6.0, place(0, z_m).y - 4.0}, ink, Anchor::left, 0.42);
    }
  }

  void draw_view(double x_m, double center_px, const cv::Scalar& color) {
    const double far_m = 1.1 * top_m_;
    const cv::Point apex = place(x_m, 0);
    const cv::Point left = place(x_m - (center_px + 0.5) / rig_.focal_px * far_m, far_m);
    const cv::Point right = place(x_m + (rig_.width_px - 0.5 - center_px) / rig_.focal_px * far_m, far_m);
    tint(image_, {apex, left, right}, color, 0.13);
    cv::line(image_, apex, left, color, 1, cv::LINE_AA);
    cv::line(image_, apex, right, color, 1, cv::LINE_AA);
  }

  /// Seen by both at a depth: from the left edge of the right image to the right edge of the left one, or the
  /// other way round, whatever the principal points make of it.
  cv::Point2d seen_by_both_m(double depth_m) const {
    const auto edge_m = [&](double x_m, double center_px, double edge_px) {
      return x_m + (edge_px - center_px) / rig_.focal_px * depth_m;
    };
    const double end_px = rig_.width_px - 0.5;
    return {std::max(edge_m(0, rig_.center_left_x_px, -0.5),
                     edge_m(rig_.baseline_m, rig_.center_right_x_px, -0.5)),
            std::min(edge_m(0, rig_.center_left_x_px, end_px),
                     edge_m(rig_.baseline_m, rig_.center_right_x_px, end_px))};
  }

  void draw_surface() {
    const DepthInterval band = figures_.one_pixel;
    const cv::Point2d near_m = seen_by_both_m(band.near_m), far_m = seen_by_both_m(band.far_m);
    tint(image_,
         {place(near_m.x, band.near_m), place(near_m.y, band.near_m), place(far_m.y, band.far_m),
          place(far_m.x, band.far_m)},
         green, 0.4);
    const double depth_m = figures_.detection_depth_m;
    cv::line(image_, place(figures_.surface_left_m, depth_m), place(figures_.surface_right_m, depth_m), green,
             3, cv::LINE_AA);
    const double middle_m = 0.5 * (figures_.surface_left_m + figures_.surface_right_m);
    const cv::Point above = place(middle_m, band.far_m), below = place(middle_m, band.near_m);
    write(image_,
          fmt::format("detects at {:.2f} m ({} px), {:.2f} m wide", depth_m, figures_.detection_disparity_px,
                      figures_.surface_right_m - figures_.surface_left_m),
          above - cv::Point(0, 12), green, Anchor::center, 0.6);
    write(image_, fmt::format("one pixel either way: {:.2f} to {:.2f} m", band.near_m, band.far_m),
          below + cv::Point(0, 22), green, Anchor::center);
    write(image_, "seen by both", place(0.5 * rig_.baseline_m + 0.55 * middle_m, 0.55 * band.near_m), ink,
          Anchor::center);
  }

  void draw_camera(double x_m, const cv::Scalar& color) {
    const cv::Point at = place(x_m, 0);
    const int half_px = std::clamp(cvRound(0.3 * rig_.baseline_m * px_per_m_), 3, 10);
    cv::rectangle(image_, at - cv::Point(half_px, 0), at + cv::Point(half_px, 14), color, cv::FILLED);
  }

  cv::Mat image_;
  const StereoRig& rig_;
  const RigFigures& figures_;
  double top_m_ = 0, bottom_m_ = 0, left_m_ = 0, px_per_m_ = 1;
};

/// One eye's image as a sheet: frame, principal point, and places to be marked on it.
class ImageSheet {
 public:
  ImageSheet(cv::Mat& image, const StereoRig& rig, cv::Point corner, int width_px)
      : image_(image), corner_(corner), scale_(static_cast<double>(width_px) / rig.width_px), rig_(rig) {}

  int height_px() const { return cvRound(scale_ * rig_.height_px); }

  void draw(const std::string& title, double center_x_px, const cv::Scalar& color) {
    write(image_, title, corner_ - cv::Point(0, 8), color);
    cv::drawMarker(image_, place(center_x_px, rig_.center_y_px), color, cv::MARKER_CROSS, 14, 2);
    cv::rectangle(image_, place(-0.5, -0.5), place(rig_.width_px - 0.5, rig_.height_px - 0.5), color, 1);
  }

  void shade_columns(double first_px, double end_px, const cv::Scalar& color) {
    const cv::Point top = place(first_px - 0.5, -0.5), bottom = place(end_px - 0.5, rig_.height_px - 0.5);
    tint(image_, {top, {bottom.x, top.y}, bottom, {top.x, bottom.y}}, color, 0.15);
  }

  void box(double first_px, double last_px, double row_px, int half_rows_px, const cv::Scalar& color) {
    const cv::Point half(0, std::max(4, cvRound(scale_ * half_rows_px)));
    cv::rectangle(image_, place(first_px, row_px) - half, place(last_px, row_px) + half, color, 2);
  }

  void arrow(double from_px, double to_px, double row_px, const cv::Scalar& color) {
    const cv::Point from = place(from_px, row_px), to = place(to_px, row_px);
    cv::line(image_, from - cv::Point(0, 7), from + cv::Point(0, 7), color, 1, cv::LINE_AA);
    if (from.x != to.x)
      cv::arrowedLine(image_, from, to, color, 1, cv::LINE_AA, 0,
                      std::min(0.5, 8.0 / std::abs(from.x - to.x)));
  }

 private:
  cv::Point place(double u_px, double v_px) const {  // clipped: a principal point may lie outside
    const double u = std::clamp(u_px, -0.5, rig_.width_px - 0.5);
    const double v = std::clamp(v_px, -0.5, rig_.height_px - 0.5);
    return corner_ + cv::Point(cvRound(scale_ * (u + 0.5)), cvRound(scale_ * (v + 0.5)));
  }

  cv::Mat& image_;
  cv::Point corner_;
  double scale_;
  const StereoRig& rig_;
};

/// What is compared: a block of the left image with its partner in the right one; and where an infinitely
/// distant point would lie.
void draw_images(cv::Mat& image, const StereoRig& rig, const RigFigures& figures, cv::Point corner,
                 int width_px) {
  constexpr int half_block_px = 2, half_window_rows_px = 8;
  const int disparity_px = figures.detection_disparity_px;
  ImageSheet left(image, rig, corner, width_px);
  ImageSheet right(image, rig, corner + cv::Point(0, left.height_px() + 40), width_px);
  const double first_px = std::max(0, disparity_px), end_px = first_px + figures.compared_columns_px;
  left.shade_columns(first_px, end_px, green);
  right.shade_columns(first_px - disparity_px, end_px - disparity_px, green);
  left.draw("left image, + its principal point", rig.center_left_x_px, blue);
  right.draw("right image", rig.center_right_x_px, orange);

  const double column_px = first_px + 0.6 * figures.compared_columns_px;  // an example
  const double row_px = 0.75 * rig.height_px, above_px = 0.6 * rig.height_px;
  const double infinity_px = 0.5 * (figures.window_first_px + figures.window_last_px);
  left.box(column_px - half_block_px, column_px + half_block_px, row_px, half_block_px, green);
  right.arrow(column_px, column_px - disparity_px, row_px, green);
  right.box(column_px - disparity_px - half_block_px, column_px - disparity_px + half_block_px, row_px,
            half_block_px, green);
  right.arrow(column_px, column_px - infinity_px, above_px, red);
  right.box(column_px - figures.window_last_px, column_px - figures.window_first_px, above_px,
            half_window_rows_px, red);

  cv::Point2d at(corner.x, corner.y + 2.0 * left.height_px() + 66);
  const auto say = [&](const std::string& text, const cv::Scalar& color) {
    write(image, text, at, color, Anchor::left, 0.45);
    at.y += 21;
  };
  say(fmt::format("block u of the left with {} of the right", column_text(disparity_px)), green);
  say(fmt::format("infinity: {} to {}", column_text(figures.window_last_px),
                  column_text(figures.window_first_px)),
      red);
  say("(drawn higher up); what matches there is refused", red);
  at.y += 10;
  say(fmt::format("{} x {} px, focal length {:.1f} px", rig.width_px, rig.height_px, rig.focal_px), ink);
  say(fmt::format("field of view left {:.1f}, right {:.1f} deg", degrees(figures.left_field_of_view_rad),
                  degrees(figures.right_field_of_view_rad)),
      ink);
  say(fmt::format("{} of {} columns compared", figures.compared_columns_px, rig.width_px), ink);
}

}  // namespace

cv::Mat draw_rig(const StereoRig& rig, const RigFigures& figures) {
  constexpr int width_px = 1280, height_px = 860, margin_px = 24, title_px = 60, panel_px = 380;
  cv::Mat image(height_px, width_px, CV_8UC3, white);
  write(image, fmt::format("{}: from above", rig.name), {margin_px, 38.0}, ink, Anchor::left, 0.8);
  TopView(image({margin_px, title_px, width_px - panel_px - 3 * margin_px, height_px - title_px - margin_px}),
          rig, figures)
      .draw();
  constexpr int sheet_height_px = 285;  // two of them, and what is said below
  const int sheet_width_px = std::min(panel_px, sheet_height_px * rig.width_px / rig.height_px);
  draw_images(image, rig, figures, {width_px - panel_px - margin_px, title_px + 20}, sheet_width_px);
  return image;
}

}  // namespace understory
