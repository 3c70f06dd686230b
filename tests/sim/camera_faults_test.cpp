#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "scenarios/flight/flight_computer.hpp"
#include "sim/cameras/image_sensor.hpp"
#include "tests/sim/camera_scenes.hpp"

/// Every fault of the cameras, measured in the images against its closed form.
namespace understory {
namespace {

StereoFrame still(const World& world, const CameraConfig& config, const Eigen::Vector3d& position = {0, 0, 0},
                  std::uint64_t seed = 1) {
  StereoCameras cameras(world, paper_rig(), config, {seed, seed});
  return cameras.capture(body_at(position, level), 0);
}

TEST(CameraFaults, TheRightImageStandsLowerByTheMisalignment) {
  const World world = black_ball({5, -0.2, 0.1}, 0.4);
  const StereoFrame aligned = still(world, noiseless());
  for (const double px : {1.0, -2.5, 7.25}) {
    CameraConfig config = noiseless();
    config.vertical_misalignment_px = px;
    const StereoFrame frame = still(world, config);
    EXPECT_TRUE(equal(frame.left, aligned.left));
    const Eigen::Vector2d moved = dark_centroid(frame.right) - dark_centroid(aligned.right);
    EXPECT_NEAR(moved.y(), px, 0.1);
    EXPECT_NEAR(moved.x(), 0, 0.1);
  }
}

TEST(CameraFaults, APixelWithManySamplesIsTheMeanOfAFinerCamerasPixels) {
  const World world = black_ball({5, -0.2, 0.1}, 0.4);
  for (const int samples : {2, 3}) {
    CameraConfig config = noiseless();
    config.supersampling = samples;
    const StereoFrame mean = still(world, config);
    StereoRig fine = paper_rig();
    fine.focal_px *= samples;
    for (double* center : {&fine.center_left_x_px, &fine.center_right_x_px})
      *center = (*center + 0.5) * samples - 0.5;
    fine.center_y_px = (fine.center_y_px + 0.5) * samples - 0.5;
    fine.width_px *= samples;
    fine.height_px *= samples;
    const StereoFrame finer =
        StereoCameras(world, fine, noiseless(), {}).capture(body_at({0, 0, 0}, level), 0);
    const std::array<std::pair<const cv::Mat*, const cv::Mat*>, 2> eyes{
        {{&mean.left, &finer.left}, {&mean.right, &finer.right}}};
    for (const auto& [image, many] : eyes) {
      ASSERT_EQ(image->size() * samples, many->size());
      for (int y = 0; y < image->rows; ++y)
        for (int x = 0; x < image->cols; ++x) {
          const double expected = cv::mean((*many)(cv::Rect(x * samples, y * samples, samples, samples)))[0];
          ASSERT_NEAR(image->at<std::uint8_t>(y, x), expected, 0.5 + 1e-9) << x << ' ' << y;
        }
    }
  }
}

TEST(CameraFaults, ABentBaselineMovesTheRightImageAsAPinholeOfThatPoseSeesIt) {
  // The ball stands on the right camera's axis: at x = baseline in the left camera's frame.
  const StereoRig rig = paper_rig();
  const double depth_m = 5;
  const World world = black_ball({depth_m, -rig.baseline_m, 0}, 0.3);
  const StereoFrame straight = still(world, noiseless());
  const auto moved = [&](const Eigen::Vector3d& position_m, const Eigen::Vector3d& rotation_rad) {
    CameraConfig config = noiseless();
    config.flex_position_m = position_m;
    config.flex_rotation_rad = rotation_rad;
    const StereoFrame frame = still(world, config);
    EXPECT_TRUE(equal(frame.left, straight.left));
    return Eigen::Vector2d(dark_centroid(frame.right) - dark_centroid(straight.right));
  };
  const double f = rig.focal_px;
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const Eigen::Vector2d shifted = moved({0.04, 0.02, 0}, none);
  EXPECT_NEAR(shifted.x(), -f * 0.04 / depth_m, 0.1);
  EXPECT_NEAR(shifted.y(), -f * 0.02 / depth_m, 0.1);
  const Eigen::Vector2d pitched = moved(none, {0.03, 0, 0}), yawed = moved(none, {0, 0.03, 0});
  EXPECT_NEAR(pitched.y(), f * std::tan(0.03), 0.1);  // it looks higher
  EXPECT_NEAR(yawed.x(), -f * std::tan(0.03), 0.1);   // it looks farther right
  EXPECT_NEAR(moved(none, {0, 0, 0.05}).norm(), 0, 0.1);
}

TEST(CameraFaults, NoiseVarianceGrowsWithTheSignalAtTheGainOverTheWell) {
  const World world = forest_world();
  CameraConfig config{.noise_gray = 1.5, .light = 0.5, .gain = 1.6, .full_well_e = 3000};
  // The photon transfer method: half the variance of the difference of two equal exposures, over their mean.
  StereoCameras cameras(world, paper_rig(), config, {1, 2});
  const Eigen::Isometry3d body = body_at({0, 0, 3}, level);
  std::array<double, 256> count{}, sum{}, squares{};
  for (int pair = 0; pair < 8; ++pair) {
    const cv::Mat one = cameras.capture(body, 2 * pair).left,
                  other = cameras.capture(body, 2 * pair + 1).left;
    CameraConfig clean = config;
    clean.noise_gray = clean.full_well_e = 0;
    static const cv::Mat signal = still(world, clean, {0, 0, 3}).left;
    for (int i = 0; i < static_cast<int>(signal.total()); ++i) {
      const double difference = double(one.data[i]) - other.data[i];
      count[signal.data[i]] += 1;
      sum[signal.data[i]] += difference;
      squares[signal.data[i]] += 0.5 * difference * difference;
    }
  }
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (int level_gray = 20; level_gray < 236; ++level_gray) {
    const auto i = static_cast<std::size_t>(level_gray);
    if (count[i] < 500) continue;
    const double variance = squares[i] / count[i];
    n += count[i], x += count[i] * level_gray, xx += count[i] * level_gray * level_gray;
    y += count[i] * variance, xy += count[i] * variance * level_gray;
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x), intercept = (y - slope * x) / n;
  EXPECT_NEAR(slope, 1.6 * 255 / 3000, 0.03 * 1.6 * 255 / 3000);
  EXPECT_NEAR(intercept, 1.5 * 1.5 + 2.0 / 12, 0.5);  // the read noise, and rounding twice
}

TEST(CameraFaults, LightAndGainMultiplyAndTheWellSaturates) {
  cv::Mat image(4, 400, CV_8UC1, cv::Scalar(100));
  PixelResponse({.light = 0.5, .gain = 3}, {}, 1).apply(0, image);
  EXPECT_EQ(cv::norm(image, cv::Mat(4, 400, CV_8UC1, cv::Scalar(150)), cv::NORM_INF), 0);
  image.setTo(100);
  PixelResponse({.light = 5, .gain = 0.5}, {}, 1).apply(0, image);  // full at 255, read at half
  EXPECT_EQ(cv::norm(image, cv::Mat(4, 400, CV_8UC1, cv::Scalar(128)), cv::NORM_INF), 0);
}

TEST(CameraFaults, CornersDarkenWithTheFourthPowerOfTheCosine) {
  const World world = bare_world("");  // sky alone
  const StereoRig rig = paper_rig();
  CameraConfig config = noiseless();
  config.vignetting_power = 4;
  const StereoFrame plain = still(world, noiseless()), dark = still(world, config);
  const auto expect_falloff = [&](const cv::Mat& bright, const cv::Mat& seen, double center_x_px) {
    double worst_gray = 0;
    for (int row = 0; row < rig.height_px; ++row)
      for (int column = 0; column < rig.width_px; ++column) {
        const double off_px = std::hypot(column - center_x_px, row - rig.center_y_px);
        const double cosine = std::cos(std::atan(off_px / rig.focal_px));
        const double expected = std::pow(cosine, 4) * bright.at<std::uint8_t>(row, column);
        worst_gray = std::max(worst_gray, std::abs(expected - seen.at<std::uint8_t>(row, column)));
      }
    EXPECT_LT(worst_gray, 0.51);
  };
  expect_falloff(plain.left, dark.left, rig.center_left_x_px);
  expect_falloff(plain.right, dark.right, rig.center_right_x_px);
  EXPECT_LT(dark.left.at<std::uint8_t>(239, 0), 60);  // 50 degrees off the axis
}

/// A black wall before the sky: the slope across its edge has the lens's standard deviation.
TEST(CameraFaults, ALensSpreadsAnEdgeAsItsGaussianSays) {
  const World wall = bare_world("<geom type='box' size='.1 5 20' rgba='0 0 0 1' pos='10 5 0'/>");
  CameraConfig config = noiseless();
  const StereoFrame sharp = still(wall, config);
  for (const double psf_px : {0.6, 1.5}) {
    config.psf_px = psf_px;
    const StereoFrame blurred = still(wall, config);
    for (const auto& [before, after] : {std::pair(sharp.left, blurred.left), {sharp.right, blurred.right}}) {
      const auto* ideal = before.ptr<std::uint8_t>(80);
      const auto* seen = after.ptr<std::uint8_t>(80);
      int edge = 8;  // first column of the sky
      while (edge < before.cols - 8 && !(ideal[edge - 1] < 5 && ideal[edge] > 50)) ++edge;
      ASSERT_LT(edge, before.cols - 8);
      double weight = 0, mean_px = 0, square_px = 0;  // of the edge's slope
      for (int at = edge - 7; at < edge + 7; ++at) {
        const double slope = seen[at] - seen[at - 1], off_px = at - edge;
        weight += slope, mean_px += slope * off_px, square_px += slope * off_px * off_px;
      }
      EXPECT_NEAR(weight, ideal[edge], 5);
      EXPECT_NEAR(mean_px / weight, 0, 0.03);
      EXPECT_NEAR(std::sqrt(square_px / weight), psf_px, 0.03 * psf_px);
    }
  }
}

/// Captures while the body moves along world y at a constant speed; the last capture's exposure ends at
/// `end_ns`. Positions at t = 0 are the origin's.
StereoFrame moving(const World& world, const CameraConfig& config, double speed_mps, std::int64_t end_ns) {
  StereoCameras cameras(world, paper_rig(), config, {1, 1});
  Eigen::Isometry3d body;
  for (std::int64_t step = 0; time_of_step_ns(step) <= end_ns; ++step) {
    const double t_s = 1e-9 * static_cast<double>(time_of_step_ns(step));
    body = body_at({0, speed_mps * t_s, 0}, level);
    cameras.observe(body, time_of_step_ns(step));
  }
  return cameras.capture(body, end_ns);
}

TEST(CameraFaults, ALateRightEyeSeesABallDisplacedBySpeedTimesDelay) {
  const double depth_m = 4, speed_mps = 9, delay_s = 0.012;
  const World world = black_ball({depth_m, 0.3, 0}, 0.4);
  CameraConfig config = noiseless();
  config.right_delay_s = delay_s;
  const std::int64_t end_ns = 50'000'000;
  const StereoFrame frame = moving(world, config, speed_mps, end_ns);
  EXPECT_EQ(frame.t_ns, end_ns - 12'000'000);
  const StereoFrame sky = still(bare_world(""), noiseless());
  const StereoFrame together = still(world, noiseless(), {0, speed_mps * 1e-9 * double(frame.t_ns), 0});
  const double left_px = shade(frame.left, sky.left).mean_px.x() - shade(together.left, sky.left).mean_px.x();
  const double right_px =
      shade(frame.right, sky.right).mean_px.x() - shade(together.right, sky.right).mean_px.x();
  EXPECT_NEAR(left_px, 0, 0.01);
  // The body moves to the left, so the ball to the right.
  EXPECT_NEAR(right_px, paper_rig().focal_px * speed_mps * delay_s / depth_m, 0.1);
}

TEST(CameraFaults, ExposureSmearsByTheWayTheImageMovesMeanwhile) {
  const double depth_m = 4, speed_mps = 12, exposure_s = 0.02;
  const World world = black_ball({depth_m, 0, 0}, 0.4);
  CameraConfig config = noiseless();
  config.exposure_s = exposure_s;
  config.exposure_views = 32;
  const std::int64_t end_ns = 100'000'000;
  const StereoFrame frame = moving(world, config, speed_mps, end_ns);
  EXPECT_EQ(frame.t_ns, end_ns - 10'000'000) << "a frame bears the middle of its exposure";
  const StereoFrame sharp = still(world, noiseless(), {0, speed_mps * 1e-9 * double(frame.t_ns), 0});
  const cv::Mat sky = still(bare_world(""), noiseless()).left;
  const Shade blurred = shade(frame.left, sky), crisp = shade(sharp.left, sky);
  EXPECT_NEAR(blurred.mean_px.x(), crisp.mean_px.x(), 0.1);
  // A box as wide as the way adds its own variance, width^2 / 12, less 1 / count^2 of it for the steps.
  const double width_px = paper_rig().focal_px * speed_mps * exposure_s / depth_m;  // 10.8
  const double added_px2 = blurred.columns_variance_px2 - crisp.columns_variance_px2;
  EXPECT_NEAR(std::sqrt(12 * added_px2 / (1 - 1.0 / (32 * 32))), width_px, 0.03 * width_px);
  EXPECT_TRUE(equal(moving(world, config, 0, end_ns).left, still(world, noiseless()).left)) << "at rest";
}

TEST(CameraFaults, ABlurredPairIsTheMeanOfItsViews) {
  const World world = forest_world();
  CameraConfig config = noiseless();
  config.exposure_s = 2 * 1.0 / physics_rate_hz;
  config.exposure_views = 2;  // at a quarter and three quarters: half a step before and after the middle
  StereoCameras cameras(world, paper_rig(), config, {1, 1});
  Eigen::Isometry3d body;
  for (int step = 0; step < 10; ++step) {
    body = body_at({0.3 * step, 0.1 * step, 3}, level);
    cameras.observe(body, time_of_step_ns(step));
  }
  const StereoFrame frame = cameras.capture(body, time_of_step_ns(9));
  const StereoFrame one = still(world, noiseless(), {0.3 * 7.5, 0.1 * 7.5, 3}),
                    other = still(world, noiseless(), {0.3 * 8.5, 0.1 * 8.5, 3});
  cv::Mat mean;
  cv::addWeighted(one.right, 0.5, other.right, 0.5, 0, mean, CV_32F);
  cv::Mat seen;
  frame.right.convertTo(seen, CV_32F);
  EXPECT_LT(cv::norm(seen, mean, cv::NORM_L1) / static_cast<double>(mean.total()), 0.5);
}

/// A camera that turns at a constant rate sees an upright edge slanted: each row lies where a camera of that
/// row's heading sees it.
TEST(CameraFaults, ARollingShutterSlantsAnEdgeByTheTurnWhileItReads) {
  const double rate_radps = 3, readout_s = 0.016;
  const StereoRig rig = paper_rig();
  const World wall = bare_world("<geom type='box' size='.1 10 40' rgba='0 0 0 1' pos='10 10 0'/>");
  CameraConfig config = noiseless();
  config.rolling_shutter_s = readout_s;
  config.rolling_shutter_views = 60;
  StereoCameras cameras(wall, rig, config, {1, 1});
  const auto heading = [&](std::int64_t t_ns) { return rate_radps * 1e-9 * static_cast<double>(t_ns); };
  const std::int64_t end_ns = time_of_step_ns(40);
  const auto body = [&](std::int64_t t_ns) {
    return body_at({0, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(heading(t_ns), Eigen::Vector3d::UnitZ())));
  };
  for (std::int64_t step = 0; step <= 40; ++step)
    cameras.observe(body(time_of_step_ns(step)), time_of_step_ns(step));
  const StereoFrame frame = cameras.capture(body(end_ns), end_ns);
  EXPECT_EQ(frame.t_ns, end_ns - 8'000'000) << "a frame bears its middle row's time";
  int compared = 0;
  for (int row = 60; row < 180; ++row) {
    const double t_s =
        1e-9 * static_cast<double>(frame.t_ns) + readout_s * ((row + 0.5) / rig.height_px - 0.5);
    // The wall's right edge is at y = 0, 9.9 m ahead of the body; the camera turns about the body.
    const Eigen::Isometry3d camera = body(std::llround(t_s * 1e9)) * rig.T_body_camera;
    const double v = (row - rig.center_y_px) / rig.focal_px;
    // The point of the edge that lies in this row: z of the world such that it projects there.
    double z = 0;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d seen = camera.inverse() * Eigen::Vector3d(9.9, 0, z);
      z += (seen.y() / seen.z() - v) * seen.z();  // up is less v
    }
    const Eigen::Vector3d seen = camera.inverse() * Eigen::Vector3d(9.9, 0, z);
    const double expected_px = rig.focal_px * seen.x() / seen.z() + rig.center_left_x_px;
    int edge = 0;
    const auto* pixels = frame.left.ptr<std::uint8_t>(row);
    while (edge < rig.width_px && pixels[edge] < 100) ++edge;
    EXPECT_NEAR(edge - 0.5, expected_px, 1.0) << row;
    ++compared;
  }
  EXPECT_EQ(compared, 120);
  config.rolling_shutter_s = 0;
  StereoCameras global(wall, rig, config, {1, 1});
  EXPECT_FALSE(equal(global.capture(body(frame.t_ns), frame.t_ns).left, frame.left));
}

TEST(CameraFaults, TheAutomaticExposureComesToItsGrayWithItsTimeConstant) {
  const CameraConfig config{.auto_exposure_s = 0.2, .auto_exposure_gray = 120};
  AutoExposure automatic(config);
  const double light_gray = 40, period_s = 1.0 / 120;
  for (int frame = 0; frame < 120; ++frame) {
    const double expected =
        120 / light_gray * std::pow(light_gray / 120, std::exp(-std::max(0, frame - 1) * period_s / 0.2));
    EXPECT_NEAR(automatic.factor(), expected, 0.02 * expected) << frame;
    automatic.observe(cv::Mat(8, 8, CV_8UC1, cv::Scalar(std::lround(light_gray * automatic.factor()))),
                      std::llround(frame * period_s * 1e9));
  }
  EXPECT_EQ(AutoExposure(CameraConfig()).factor(), 1);

  // At a quarter of the light the gain is four times as high, and so is the noise.
  const World sky = bare_world("");
  CameraConfig dark{.noise_gray = 1, .auto_exposure_s = 0.05, .light = 0.25};
  dark.auto_exposure_gray = cv::mean(still(sky, noiseless()).left)[0];
  StereoCameras cameras(sky, paper_rig(), dark, {1, 2});
  StereoFrame frame;
  for (int i = 0; i < 120; ++i)
    frame = cameras.capture(body_at({0, 0, 0}, level), std::llround(i * period_s * 1e9));
  cv::Scalar mean, deviation;
  cv::meanStdDev(frame.left.row(0), mean, deviation);  // one height: one gray
  EXPECT_NEAR(cv::mean(frame.left)[0], dark.auto_exposure_gray, 1.5);
  EXPECT_NEAR(deviation[0], 4, 0.6);
}

TEST(CameraFaults, ABayerSensorSpreadsAPixelAsItsInterpolationSays) {
  CameraConfig config = noiseless();
  config.bayer = true;
  const World sky = bare_world("");
  const cv::Mat plain = still(sky, noiseless()).left, colour = still(sky, config).left;
  cv::Mat difference;
  cv::absdiff(plain.rowRange(2, 238).colRange(2, 374), colour.rowRange(2, 238).colRange(2, 374), difference);
  EXPECT_LE(cv::norm(difference, cv::NORM_INF), 2);  // a smooth sky stays
  // An upright edge: the two columns beside it mix, others stay.
  const World wall = bare_world("<geom type='box' size='.1 5 20' rgba='0 0 0 1' pos='10 5 0'/>");
  const cv::Mat sharp = still(wall, noiseless()).left, mixed = still(wall, config).left;
  const auto* before = sharp.ptr<std::uint8_t>(80);
  int edge = 8;
  while (edge < sharp.cols - 8 && !(before[edge - 1] < 5 && before[edge] > 50)) ++edge;
  ASSERT_LT(edge, sharp.cols - 8);
  double dark_side = 0, bright_side = 0;
  for (int row = 80; row < 120; ++row) {
    const auto* after = mixed.ptr<std::uint8_t>(row);
    dark_side += after[edge - 1] / 40.0;
    bright_side += (before[edge] - after[edge]) / 40.0;
    EXPECT_LE(after[edge - 3], 5);
    EXPECT_NEAR(after[edge + 2], before[edge + 2], 3);
  }
  // What of the column beyond the edge enters a gray level (BT.601), by pencil: in a column of red and green
  // pixels, at red a quarter of green and half of blue, at green half of blue; in one of green and blue the
  // same with red for blue.
  const double red = 0.299, green = 0.587, blue = 0.114;
  const double of_red_column = (green / 4 + blue / 2 + blue / 2) / 2,
               of_blue_column = (green / 4 + red / 2 + red / 2) / 2;
  EXPECT_NEAR(std::min(dark_side, bright_side) / before[edge], of_red_column, 0.01);
  EXPECT_NEAR(std::max(dark_side, bright_side) / before[edge], of_blue_column, 0.01);
}

TEST(CameraFaults, FramesDropAsOftenAsTheProbabilitySays) {
  FrameDrops drops(0.05, 7), again(0.05, 7), never(0, 7), always(1, 7);
  int lost = 0;
  constexpr int count = 100'000;
  for (int i = 0; i < count; ++i) {
    const bool is_lost = drops.next();
    EXPECT_EQ(is_lost, again.next());
    EXPECT_FALSE(never.next());
    EXPECT_TRUE(always.next());
    lost += is_lost;
  }
  EXPECT_NEAR(lost, 0.05 * count, 4 * std::sqrt(0.05 * 0.95 * count));
}

TEST(RoundedGaussians, AreTheStandardLibrarysRounded) {
  constexpr std::size_t count = 1 << 17;
  for (const double deviation : {1e-3, 0.3, 1.0, 2.0, 7.5, 60.0, 1e4})
    for (const std::uint64_t seed : {0u, 1u, 1000u}) {
      std::mt19937_64 ours(seed), theirs(seed);
      const std::vector<std::int8_t> rounded = rounded_gaussians(count, deviation, ours);
      std::normal_distribution<double> gaussian(0.0, deviation);
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(rounded[i], std::clamp(std::lround(gaussian(theirs)), -127L, 127L))
            << "number " << i << ", deviation " << deviation << ", seed " << seed;
      EXPECT_EQ(ours, theirs);  // as many draws
    }
}

}  // namespace
}  // namespace understory
