#pragma once

#include <string>
#include <vector>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/report/line_plot.hpp"

namespace understory {

/// What a person wants to know of a rig, derived from its calibration by the detector's own rules.
struct RigFigures {
  double left_field_of_view_rad = 0;  ///< horizontal, from edge to edge of the rectified image
  double right_field_of_view_rad = 0;
  double vertical_field_of_view_rad = 0;
  int detection_disparity_px = 0;  ///< the whole disparity nearest to the requested depth
  double detection_depth_m = 0;    ///< its depth
  DepthInterval one_pixel;         ///< one pixel of disparity to either side
  int window_first_px = 0;         ///< the invariance filter searches the right image from column
  int window_last_px = 0;          ///<   u_left - window_last_px to u_left - window_first_px
  int compared_columns_px = 0;     ///< of the left image: those whose partner lies in the right one
  double surface_left_m = 0;       ///< the detection surface's edges right of the left camera
  double surface_right_m = 0;
};

/// `config`: whose invariance window is shown.
RigFigures rig_figures(const StereoRig& rig, const PushbroomConfig& config);

double degrees(double angle_rad);

/// The column of the right image that a disparity means for column u of the left: "u - 105".
std::string column_text(int disparity_px);

/// The figures as lines of text, for one screen.
std::string to_report(const CalibratedRig& calibrated, const RigFigures& figures);

/// The rig from above, in metres: both cameras' fields of view, the surface that the detector looks at and
/// its one-pixel interval; beside it which columns of the two images are compared.
std::vector<LinePlot> rig_plots(const StereoRig& rig, const RigFigures& figures);

}  // namespace understory
