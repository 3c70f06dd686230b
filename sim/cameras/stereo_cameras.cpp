#include "sim/cameras/stereo_cameras.hpp"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "sim/cameras/image_sensor.hpp"
#include "sim/cameras/stereo_optics.hpp"
#include "sim/render/eye.hpp"
#include "sim/render/scene_renderer.hpp"
#include "sim/scene/scenery.hpp"

namespace understory {
namespace {

/// The body's recent poses, for images with an exposure time.
class PoseHistory {
 public:
  explicit PoseHistory(std::int64_t kept_ns) : kept_ns_(kept_ns) {}
  /// Times strictly increasing; a moment already known is left alone.
  void observe(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns);
  /// Between two observed moments the position linearly, the attitude along the shorter arc; exactly the
  /// observed pose at an observed moment; the oldest pose before all, the newest after all. Asks for one.
  Eigen::Isometry3d at(std::int64_t t_ns) const;

 private:
  struct Moment {
    std::int64_t t_ns;
    Eigen::Isometry3d T_world_body;
  };
  std::int64_t kept_ns_;
  std::deque<Moment> moments_;
};

void PoseHistory::observe(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns) {
  if (!moments_.empty() && t_ns <= moments_.back().t_ns) return;
  moments_.push_back({t_ns, T_world_body});
  while (moments_.size() > 1 && moments_[1].t_ns <= t_ns - kept_ns_) moments_.pop_front();
}

Eigen::Isometry3d PoseHistory::at(std::int64_t t_ns) const {
  if (moments_.empty()) throw std::logic_error("no pose was observed before it is asked for");
  const auto later = std::lower_bound(moments_.begin(), moments_.end(), t_ns,
                                      [](const Moment& moment, std::int64_t t) { return moment.t_ns < t; });
  if (later == moments_.end()) return moments_.back().T_world_body;
  if (later == moments_.begin() || later->t_ns == t_ns) return later->T_world_body;
  const Moment& earlier = *std::prev(later);
  const double part =
      static_cast<double>(t_ns - earlier.t_ns) / static_cast<double>(later->t_ns - earlier.t_ns);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() =
      (1 - part) * earlier.T_world_body.translation() + part * later->T_world_body.translation();
  pose.linear() = Eigen::Quaterniond(earlier.T_world_body.linear())
                      .slerp(part, Eigen::Quaterniond(later->T_world_body.linear()))
                      .toRotationMatrix();
  return pose;
}

mjtNum* joint_angle(const mjModel& model, mjData& data, const char* name) {
  const int joint = mj_name2id(&model, mjOBJ_JOINT, name);
  if (joint < 0) throw std::runtime_error(std::string("the model has no joint ") + name);
  return data.qpos + model.jnt_qposadr[joint];
}

/// The model's aircraft, placed as `truth` has it.
DataPointer placed_aircraft(const mjModel& model, const Truth& truth) {
  DataPointer data(mj_makeData(&model));
  const Eigen::Vector3d& place = truth.T_world_body.translation();
  const Eigen::Quaterniond turn(truth.T_world_body.linear());
  const double pose[] = {place.x(), place.y(), place.z(), turn.w(), turn.x(), turn.y(), turn.z()};
  std::ranges::copy(pose, joint_angle(model, *data, "aircraft_free"));
  *joint_angle(model, *data, "left_elevon") = truth.left_elevon_rad;
  *joint_angle(model, *data, "right_elevon") = truth.right_elevon_rad;
  mj_kinematics(&model, data.get());
  return data;
}

std::array<cv::Mat, 2> falloff_of(const StereoOptics& optics, const CameraConfig& config) {
  if (config.vignetting_power <= 0) return {};
  return {optics.falloff(0, config.vignetting_power), optics.falloff(1, config.vignetting_power)};
}

/// The same view with `samples` pixels for each along either axis.
Eye finer(Eye eye, int samples) {
  eye.focal_px *= samples;
  eye.center_x_px = (eye.center_x_px + 0.5) * samples - 0.5;
  eye.center_y_px = (eye.center_y_px + 0.5) * samples - 0.5;
  eye.width_px *= samples;
  eye.height_px *= samples;
  return eye;
}

}  // namespace

Eye chase_eye(const Eigen::Isometry3d& T_world_body, int width_px, int height_px) {
  const Eigen::Vector3d forward = T_world_body.linear().col(0);
  const double yaw_rad = std::atan2(forward.y(), forward.x());
  constexpr double behind_m = 3.2, above_m = 1.1, down_rad = 0.20;
  Eye eye{Eigen::Isometry3d::Identity(), 0.8 * width_px, 0.5 * (width_px - 1),
          0.5 * (height_px - 1),         width_px,       height_px};
  const Eigen::Vector3d ahead(std::cos(yaw_rad), std::sin(yaw_rad), 0);
  eye.T_world_camera.translation() =
      T_world_body.translation() - behind_m * ahead + above_m * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d gaze = std::cos(down_rad) * ahead - std::sin(down_rad) * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d right = gaze.cross(Eigen::Vector3d::UnitZ()).normalized();
  eye.T_world_camera.linear() << right, gaze.cross(right), gaze;
  return eye;
}

struct StereoCameras::Implementation {
  const mjModel& model;
  StereoRig rig;
  CameraConfig config;
  StereoOptics optics;
  SceneRenderer scene;
  PixelResponse response;
  ImageNoise noise;
  AutoExposure automatic;
  std::int64_t exposure_ns, right_delay_ns, readout_ns;
  PoseHistory poses;

  Implementation(const mjModel& model_, const StereoRig& rig_, const CameraConfig& config_, CameraSeeds seeds,
                 const std::optional<StereoCalibration>& raw, RendererKind renderer,
                 const std::shared_ptr<const WoodsMesh>& woods)
      : model(model_),
        rig(rig_),
        config(config_),
        optics(rig, config, raw),
        scene(model, config.view_distance_m, 2 * config.supersampling * rig.width_px,
              config.supersampling * rig.height_px, renderer, woods),
        response(config, falloff_of(optics, config), seeds.shot),
        noise(config.noise_gray, seeds.noise),
        automatic(config),
        exposure_ns(config.exposure_ns()),
        right_delay_ns(config.right_delay_ns()),
        readout_ns(config.readout_ns()),
        poses(exposure_ns + right_delay_ns + readout_ns) {}

  bool takes_time() const { return exposure_ns > 0 || right_delay_ns > 0 || readout_ns > 0; }

  /// Both views at one moment, each pixel the mean of its samples.
  std::array<cv::Mat, 2> rendered(std::array<Eye, 2> eyes) {
    if (config.supersampling == 1) return scene.gray_pair(eyes);
    for (Eye& eye : eyes) eye = finer(eye, config.supersampling);
    std::array<cv::Mat, 2> views = scene.gray_pair(eyes);
    const double scale = 1.0 / config.supersampling;
    for (cv::Mat& view : views) cv::resize(view, view, {}, scale, scale, cv::INTER_AREA);
    return views;
  }

  /// Both images, the last row of which is exposed until t_ns.
  std::array<cv::Mat, 2> captured(const Eigen::Isometry3d& now, std::int64_t t_ns) {
    if (takes_time()) poses.observe(now, t_ns);
    std::array<cv::Mat, 2> images = readout_ns > 0 ? read_out(now, t_ns) : exposed(now, t_ns);
    // In 8 bits OpenCV blurs with whole numbers, the same on every machine.
    if (config.psf_px > 0)
      for (cv::Mat& image : images) cv::GaussianBlur(image, image, {}, config.psf_px);
    return images;
  }

  /// Each band of rows is of an image that was exposed when the band's middle row was.
  std::array<cv::Mat, 2> read_out(const Eigen::Isometry3d& now, std::int64_t t_ns) {
    const int count = config.rolling_shutter_views;
    std::array<cv::Mat, 2> images;
    for (int band = 0; band < count; ++band) {
      const std::array<cv::Mat, 2> whole =
          exposed(now, t_ns - readout_ns + (2 * band + 1) * readout_ns / (2 * count));
      for (std::size_t eye = 0; eye < 2; ++eye) {
        images[eye].create(whole[eye].size(), whole[eye].type());
        const cv::Range rows(band * whole[eye].rows / count, (band + 1) * whole[eye].rows / count);
        whole[eye].rowRange(rows).copyTo(images[eye].rowRange(rows));
      }
    }
    return images;
  }

  /// Both images of an exposure that ends at t_ns, before the lens's blur: the mean of views spread evenly
  /// over the exposure.
  std::array<cv::Mat, 2> exposed(const Eigen::Isometry3d& now, std::int64_t t_ns) {
    std::array<cv::Mat, 2> views, sums;
    if (!takes_time()) {
      views = rendered(optics.eyes(now, now));
    } else {
      const int count = exposure_ns > 0 ? config.exposure_views : 1;
      for (int i = 0; i < count; ++i) {
        const std::int64_t right_ns = t_ns - exposure_ns + (2 * i + 1) * exposure_ns / (2 * count);
        views = rendered(optics.eyes(poses.at(right_ns - right_delay_ns), poses.at(right_ns)));
        for (std::size_t eye = 0; eye < 2; ++eye) {
          if (sums[eye].empty()) sums[eye] = cv::Mat::zeros(views[eye].size(), CV_32SC1);
          cv::add(sums[eye], views[eye], sums[eye], cv::noArray(), CV_32SC1);
        }
      }
      for (std::size_t eye = 0; eye < 2; ++eye) sums[eye].convertTo(views[eye], CV_8UC1, 1.0 / count);
    }
    return {optics.image(0, views[0]), optics.image(1, views[1])};
  }
};

StereoCameras::StereoCameras(const World& world, const StereoRig& rig, const CameraConfig& config,
                             CameraSeeds seeds, const std::optional<StereoCalibration>& raw,
                             RendererKind renderer) {
  paint_textures(*world.model, world.config);
  if (world.woods) paint(*world.woods);
  implementation_ =
      std::make_unique<Implementation>(*world.model, rig, config, seeds, raw, renderer, world.woods);
}

StereoCameras::~StereoCameras() = default;

void StereoCameras::observe(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns) {
  if (implementation_->takes_time()) implementation_->poses.observe(T_world_body, t_ns);
}

StereoFrame StereoCameras::capture(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns) {
  Implementation& self = *implementation_;
  StereoFrame frame{t_ns - self.config.exposure_lag_ns(), {}, {}};
  if (self.config.lens_cap) {
    const cv::Size size(self.rig.width_px, self.rig.height_px);
    frame.left = cv::Mat::zeros(size, CV_8UC1);
    frame.right = cv::Mat::zeros(size, CV_8UC1);
  } else {
    const auto images = self.captured(T_world_body, t_ns);
    frame.left = images[0];
    frame.right = images[1];
  }
  const float automatic = self.automatic.factor(), amplified = std::max(automatic, 1.0f);
  self.response.apply(0, frame.left, automatic);
  self.response.apply(1, frame.right, automatic);
  self.noise.add_to(frame.left, amplified);
  self.noise.add_to(frame.right, amplified);
  self.automatic.observe(frame.left, t_ns);
  if (self.config.bayer)
    for (cv::Mat* image : {&frame.left, &frame.right})
      cv::cvtColor(image->clone(), *image, cv::COLOR_BayerRG2GRAY);
  return frame;
}

void StereoCameras::redraw(CameraSeeds seeds) {
  implementation_->noise.redraw(seeds.noise);
  implementation_->response.redraw(seeds.shot);
}

cv::Mat StereoCameras::depth(const Eigen::Isometry3d& T_world_body) const {
  return implementation_->scene.left_depth(eyes_of(implementation_->rig, T_world_body));
}

TrueView StereoCameras::true_view(const Eigen::Isometry3d& T_world_body) const {
  return implementation_->scene.true_left_view(eyes_of(implementation_->rig, T_world_body));
}

cv::Mat StereoCameras::chase_view(const Truth& truth, int width_px, int height_px) const {
  return implementation_->scene.colour_with_aircraft(*placed_aircraft(implementation_->model, truth),
                                                     chase_eye(truth.T_world_body, width_px, height_px));
}

std::string StereoCameras::renderer() const { return implementation_->scene.name(); }

}  // namespace understory
