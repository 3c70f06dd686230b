#include "sim/cameras/camera_config.hpp"

#include "perception/field_visitor.hpp"

namespace understory {

void visit_fields(FieldVisitor& visit, CameraConfig& config) {
  visit("lens_cap", config.lens_cap,
        "makes the images black except for noise, to check that flights depend on vision");
  visit("noise_gray", config.noise_gray, 0.0, 50.0,
        "standard deviation of the sensor noise, independent for each pixel");
  visit("view_distance_m", config.view_distance_m, 5.0, 200.0,
        "distance beyond which obstacles are not drawn");
  visit("exposure_s", config.exposure_s, 0.0, 0.02,
        "Exposure time. A frame's timestamp is the middle of its left exposure. Outdoors such cameras expose "
        "for some 0.1 to 5 ms (our assumption). 0: an instant.");
  visit("exposure_views", config.exposure_views, 1, 64,
        "Number of images rendered at times spread over the exposure and averaged; each costs a rendering. "
        "At 4 ms of exposure, more than four change nothing for the planner.");
  visit("rolling_shutter_s", config.rolling_shutter_s, 0.0, 0.05,
        "Time from the exposure of an image's first row to that of its last; the line time is this over the "
        "rows. A frame's timestamp, and the true pose and depth of recordings, are of its middle row. 0: a "
        "global shutter.");
  visit("rolling_shutter_views", config.rolling_shutter_views, 2, 64,
        "Number of images rendered at times spread over the readout. Each gives a band of rows, within which "
        "nothing moves.");
  visit(
      "auto_exposure_s", config.auto_exposure_s, 0.0, 10.0,
      "Time constant with which the camera brings the left image's mean to auto_exposure_gray: by a shorter "
      "exposure, or by more gain, which amplifies the noise. It acts on later frames. 0: no automatic.");
  visit("auto_exposure_gray", config.auto_exposure_gray, 10.0, 245.0,
        "mean gray level that the automatic exposure aims at");
  visit("light", config.light, 0.001, 10.0,
        "light that reaches a pixel, as a factor on the rendered brightness; less than 1 at dusk");
  visit("gain", config.gain, 0.1, 64.0, "factor by which the camera amplifies a pixel's signal");
  visit("full_well_e", config.full_well_e, 0.0, 1e6,
        "Electrons in a pixel at gray 255 and gain 1; N electrons have shot noise of sqrt(N) rms. Some "
        "10,000 in a pixel of 6 um (our assumption). 0: no shot noise.");
  visit("vignetting_power", config.vignetting_power, 0.0, 16.0,
        "Exponent n of the vignetting, a falloff with cos^n of the angle to the optical axis: 4 for a plain "
        "lens (the cosine-fourth law), 0 for none. The default with world.scenery woods is 4.");
  visit("psf_px", config.psf_px, 0.0, 5.0,
        "Standard deviation of the lens's point spread function, a Gaussian, in pixels of the camera's "
        "image; 0 for none. The default with world.scenery woods is 0.6.");
  visit(
      "supersampling", config.supersampling, 1, 4,
      "Number of samples of a pixel along either axis: images are rendered so many times as wide and as high "
      "and averaged down. For recordings and stills: the rendering takes about its square times as long.");
  visit(
      "bayer", config.bayer,
      "Gives the images of a colour sensor with a Bayer pattern, turned to gray: bilinear, weights of ITU-R "
      "BT.601. What is rendered is gray: this costs sharpness, and makes the noise of neighbours alike.");
  visit("vertical_misalignment_px", config.vertical_misalignment_px, -20.0, 20.0,
        "Distance by which the right image lies lower than the stack assumes, in pixels of the camera's "
        "image.");
  visit("flex_position_m", config.flex_position_m, -0.1, 0.1,
        "Displacement of the right camera from its calibrated position, along its rectified axes (x right, y "
        "down, z forward): a bent baseline. The stack does not know it.");
  visit("flex_rotation_rad", config.flex_rotation_rad, -0.1, 0.1,
        "Rotation vector of the right camera from its calibrated orientation, about its rectified axes. The "
        "stack does not know it.");
  visit("right_delay_s", config.right_delay_s, 0.0, 0.02,
        "time by which the right image is exposed later than the left");
}

}  // namespace understory
