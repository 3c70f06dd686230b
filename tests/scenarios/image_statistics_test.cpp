#include "scenarios/evaluation/image_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "perception/io/calibration/calibration_file.hpp"
#include "scenarios/evaluation/pair_evaluation.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

/// Pairs of whatever source: each figure on images that are made so that it is known.
namespace understory {
namespace {

using namespace support;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

cv::Mat normal_noise(cv::Size size, double mean, double deviation, std::uint64_t seed) {
  cv::Mat values(size, CV_32F), image;
  cv::RNG generator(seed);
  generator.fill(values, cv::RNG::NORMAL, mean, deviation);
  values.convertTo(image, CV_8U);
  return image;
}

/// Random phases under a spectrum of power 1 / f^slope.
cv::Mat with_slope(double slope, std::uint64_t seed) {
  constexpr int size = 256;
  cv::Mat values(size, size, CV_64F), spectrum, image;
  cv::RNG generator(seed);
  generator.fill(values, cv::RNG::NORMAL, 0, 1);
  cv::dft(values, spectrum, cv::DFT_COMPLEX_OUTPUT);
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double v = row < size / 2 ? row : row - size, u = column < size / 2 ? column : column - size;
      spectrum.at<cv::Vec2d>(row, column) *= u == 0 && v == 0 ? 0.0 : std::pow(std::hypot(u, v), -slope / 2);
    }
  cv::dft(spectrum, values, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  cv::Scalar mean, deviation;
  cv::meanStdDev(values, mean, deviation);
  values.convertTo(image, CV_8U, 40 / deviation[0], 128);
  return image;
}

/// The right image shows everything `disparity` columns further left.
ImagePair shifted(const cv::Mat& wide, int disparity_px) {
  const int width = wide.cols - disparity_px;
  ImagePair pair{"shifted",
                 wide(cv::Rect(0, 0, width, wide.rows)).clone(),
                 wide(cv::Rect(disparity_px, 0, width, wide.rows)).clone(),
                 {}};
  pair.disparity_px = cv::Mat(pair.left.size(), CV_32F, cv::Scalar(disparity_px));
  return pair;
}

TEST(ImageStatistics, TheSlopeIsThatOfTheSpectrum) {
  for (const double slope : {1.0, 1.88, 2.5}) {
    std::vector<ImagePair> pairs;
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
      pairs.push_back({"made", with_slope(slope, seed), with_slope(slope, seed), {}});
    EXPECT_NEAR(image_statistics("made", pairs).power_slope, slope, 0.06) << slope;
  }
}

TEST(ImageStatistics, NoiseIsThatOfTheSensorAndNotOfTheTexture) {
  for (const double deviation : {1.5, 3.0, 6.0}) {
    // Half of the image is flat, the other half a ramp with coarse texture.
    cv::Mat left = normal_noise({400, 200}, 100, deviation, 1),
            right = normal_noise({400, 200}, 100, deviation, 2);
    const cv::Mat texture = with_slope(2.5, 3)(cv::Rect(0, 0, 200, 200));
    texture.copyTo(left(cv::Rect(0, 0, 200, 200)));
    texture.copyTo(right(cv::Rect(0, 0, 200, 200)));
    const ImageStatistics measured =
        image_statistics("made", {{"made", left, right, cv::Mat(left.size(), CV_32F, cv::Scalar(0))}});
    // The flattest tenth of blocks is somewhat quieter than all, and gray levels are whole.
    EXPECT_NEAR(measured.noise_gray, deviation, 0.35 * deviation) << deviation;
  }
}

TEST(ImageStatistics, NoiseOfPairsIsWhatTheTwoImagesDoNotShare) {
  const cv::Mat shared = with_slope(2, 5);
  cv::Mat left, right, noise(shared.size(), CV_16S);
  cv::RNG generator(7);
  for (cv::Mat* image : {&left, &right}) {
    generator.fill(noise, cv::RNG::NORMAL, 0, 3);
    cv::add(shared, noise, *image, cv::noArray(), CV_8U);
  }
  ImagePair pair{"made", left, right, cv::Mat(left.size(), CV_32F, cv::Scalar(0))};
  const ImageStatistics measured = image_statistics("made", {pair});
  EXPECT_NEAR(measured.pair_noise_gray, 3, 0.4);
  EXPECT_GT(measured.noise_gray, 3);  // the texture is in it, too
  pair.disparity_px.setTo(unknown);
  EXPECT_TRUE(std::isnan(image_statistics("made", {pair}).pair_noise_gray));
}

TEST(ImageStatistics, TrueMatchesAreExactAndChanceOnesAreWhatChanceGives) {
  cv::Mat wide(200, 300, CV_8U);
  cv::RNG generator(3);
  generator.fill(wide, cv::RNG::UNIFORM, 0, 256);
  const ImageStatistics measured = image_statistics("made", {shifted(wide, 9)});
  EXPECT_EQ(measured.true_sad, 0);
  EXPECT_EQ(measured.true_score, 0);
  EXPECT_NEAR(measured.chance_sad, 25 * (256 * 256 - 1) / (3.0 * 256), 30);  // of two even draws, 85.3 each
  EXPECT_EQ(measured.edges_over_860, 1);
  EXPECT_NEAR(measured.along_gray, 85.3, 1);
  EXPECT_NEAR(measured.across_gray, 85.3, 1);
  EXPECT_NEAR(measured.clipped, 2 / 256.0, 0.001);
  EXPECT_NEAR(measured.mean_gray, 127.5, 1);
  EXPECT_NEAR(measured.dark_gray, 0.05 * 256, 2);
  EXPECT_NEAR(measured.bright_gray, 0.95 * 256, 2);
}

TEST(ImageStatistics, StepsTellAlongFromAcross) {
  cv::Mat stripes(64, 64, CV_8U);
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column)
      stripes.at<std::uint8_t>(row, column) =
          static_cast<std::uint8_t>(100 + 2 * column % 100 + (row % 2) * 7);
  const ImageStatistics measured = image_statistics("made", {{"made", stripes, stripes, {}}});
  EXPECT_NEAR(measured.across_gray, 7, 1e-9);
  EXPECT_NEAR(measured.along_gray, (62 * 2 + 98) / 63.0, 1e-9);  // one step back to the beginning
}

TEST(ImagePairs, ReadsPairsWithTheirDisparitiesAndSaysWhatIsWrong) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::filesystem::path& at) {
    return refusal_of([&] { read_image_pairs(at, 1); });
  };
  expect_part(refusal(folder.path() / "none"), "there is no such folder");
  expect_part(refusal(folder.path()),
              "expected a recording in EuRoC's layout, KITTI's folder, left.png and right.png");
  const std::filesystem::path one = folder.path() / "set" / "one";
  std::filesystem::create_directories(one);
  const cv::Mat image = normal_noise({64, 48}, 100, 20, 1);
  cv::imwrite(one / "left.png", image);
  cv::imwrite(one / "right.png", image);
  EXPECT_TRUE(read_image_pairs(one, 1).at(0).disparity_px.empty());
  cv::Mat steps(48, 64, CV_16U, cv::Scalar(256 * 4 + 64));
  steps.at<std::uint16_t>(0, 0) = 0;
  cv::imwrite(one / "disparity.png", steps);
  for (const std::filesystem::path& at : {one, folder.path() / "set", one / ""}) {
    const ImagePair pair = read_image_pairs(at, 5).at(0);
    EXPECT_EQ(pair.name, "one");
    EXPECT_EQ(cv::norm(pair.left, image, cv::NORM_INF), 0);
    EXPECT_TRUE(std::isnan(pair.disparity_px.at<float>(0, 0)));
    EXPECT_EQ(pair.disparity_px.at<float>(3, 5), 4.25F);
    const ImagePair narrow = narrowed(pair, 32);
    EXPECT_EQ(narrow.left.size(), cv::Size(32, 24));
    EXPECT_EQ(narrow.disparity_px.at<float>(3, 5), 2.125F);
    EXPECT_EQ(narrowed(pair, 100).left.size(), pair.left.size());
  }
  // A calibration beside it makes depths of disparities; of another size it is refused.
  const std::string calibration =
      "cam0=[100 0 32; 0 100 24; 0 0 1]\ncam1=[100 0 32; 0 100 24; 0 0 1]\ndoffs=0\nbaseline=200\n";
  folder.write("set/one/calib.txt", calibration + "width=64\nheight=48\nndisp=20\n");
  EXPECT_NEAR(read_image_pairs(one, 1).at(0).rig.value().depth_m(4), 5, 1e-12);
  folder.write("set/one/calib.txt", calibration + "width=65\nheight=48\nndisp=20\n");
  expect_part(refusal(one), "calib.txt: is of images of 65x48, left.png has 64x48");
  folder.write("set/one/calib.txt", "cam0=[100 0 32\n");
  expect_part(refusal(one), "calib.txt:1: cam0");
  std::filesystem::remove(one / "calib.txt");
  cv::imwrite(one / "disparity.png", steps(cv::Rect(0, 0, 10, 10)));
  expect_part(refusal(one), "the disparities must be 64x48 as left.png, are 10x10");
  cv::imwrite(one / "right.png", image(cv::Rect(0, 0, 60, 48)));
  expect_part(refusal(one), "right.png: must be 64x48 as left.png, is 60x48");
  expect_part(refusal_of([] {
                image_statistics("small", {{"a", cv::Mat(8, 8, CV_8U), cv::Mat(8, 8, CV_8U), {}}});
              }),
              "small: a: must be at least 32 pixels wide and high, is 8x8");
}

/// A wall at one disparity before another one, each with fine texture.
ImagePair two_walls(int near_px, int far_px) {
  cv::Mat far(240, 500, CV_8U), near(240, 500, CV_8U);
  cv::RNG generator(11);
  generator.fill(far, cv::RNG::UNIFORM, 0, 256);
  generator.fill(near, cv::RNG::UNIFORM, 0, 256);
  const cv::Rect image(0, 0, 376, 240), left_half(150, 0, 100, 240);
  ImagePair pair{"walls", far(image).clone(), far(image + cv::Point(far_px, 0)).clone(), {}};
  pair.disparity_px = cv::Mat(image.size(), CV_32F, cv::Scalar(far_px));
  near(left_half).copyTo(pair.left(left_half));
  near(left_half).copyTo(pair.right(left_half - cv::Point(near_px, 0)));
  pair.disparity_px(left_half).setTo(near_px);
  return pair;
}

TEST(PairEvaluation, FindsWhatIsThereAtEachDisparityAndNothingElse) {
  const StereoRig rig =
      read_calibrated_rig(std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models/rigs/long.yaml", {}).rig;
  const ImagePair pair = two_walls(24, 12);
  EXPECT_EQ(whole_disparities(pair, rig).front(), 12);
  EXPECT_EQ(whole_disparities(pair, rig).back(), 24);
  int done = 0;
  const std::vector<PairScore> scores = evaluate_pairs({pair}, {}, rig, [&] { ++done; });
  EXPECT_EQ(done, 13);
  ASSERT_EQ(scores.size(), 4u);
  for (const PairScore& score : scores) {
    EXPECT_EQ(score.disparities, 13);
    EXPECT_GT(score.rates.precision.value(), 0.97) << score.algorithm;
    // At 11, 13, 23 and 25 px the walls are within a pixel as well; a rule for whole disparities is silent.
    // The paper's invariance filter takes most of such noise for a likeness at infinity.
    if (score.algorithm != "pushbroom, original") {
      EXPECT_GT(score.rates.recall.value(), 0.3) << score.algorithm;
    }
  }
  // The other way round nothing matches.
  const ImagePair swapped{"swapped", pair.right, pair.left, pair.disparity_px};
  for (const PairScore& score : evaluate_pairs({swapped}, {}, rig, [] {}))
    EXPECT_LT(score.rates.recall.value(), 0.05) << score.algorithm;
  const Table table = pair_table(scores);
  EXPECT_EQ(table.rows.size(), 8u);  // and the sums
  EXPECT_EQ(table.rows[4][0], "all");
  ImagePair unknown_truth = pair;
  unknown_truth.disparity_px.setTo(unknown);
  expect_part(refusal_of([&] { evaluate_pairs({unknown_truth}, {}, rig, [] {}); }), "no pixel has a true");
  unknown_truth.disparity_px.release();
  expect_part(refusal_of([&] { evaluate_pairs({unknown_truth}, {}, rig, [] {}); }),
              "walls: requires disparity.png or disparity.pfm");
}

/// As KITTI's stereo benchmarks, Middlebury and ETH3D unpack: colour becomes gray, the colour pair has its
/// own calibration, only the first image of a KITTI pair has disparities.
TEST(ImagePairs, ReadsTheFoldersOfBenchmarks) {
  const TemporaryFolder folder;
  const cv::Mat gray = normal_noise({64, 48}, 100, 20, 1);
  cv::Mat colour, steps(48, 64, CV_16U, cv::Scalar(256 * 5)), disparity(48, 64, CV_32F, cv::Scalar(6.5));
  cv::cvtColor(gray, colour, cv::COLOR_GRAY2BGR);
  const auto write = [&](const std::string& name, const cv::Mat& image) {
    std::filesystem::create_directories((folder.path() / name).parent_path());
    cv::imwrite(folder.path() / name, image);
  };
  for (const std::string eye : {"2015/training/image_2/", "2015/training/image_3/"})
    for (const char* name : {"000003_10.png", "000003_11.png", "000007_10.png"}) write(eye + name, colour);
  for (const std::string eye : {"2012/training/image_0/", "2012/training/image_1/"})
    write(eye + "000000_10.png", gray);
  write("2015/training/disp_occ_0/000003_10.png", steps);
  write("2015/training/disp_occ_0/000007_10.png", steps);
  write("2012/training/disp_occ/000000_10.png", steps);
  const auto projection = [](const char* key, double shift) {
    return std::string(key) + ": 100 0 32 " + std::to_string(shift) + " 0 100 24 0 0 0 1 0\n";
  };
  folder.write("2015/training/calib_cam_to_cam/000003.txt",
               "S_rect_00: 64 48\n" + projection("P_rect_00", 0) + projection("P_rect_01", -54) +
                   projection("P_rect_02", 5) + projection("P_rect_03", -48));
  folder.write("2012/training/calib/000000.txt", projection("P0", 0) + projection("P1", -54));
  for (const char* at : {"2015", "2015/training"}) {
    const std::vector<ImagePair> pairs = read_image_pairs(folder.path() / at, 1);
    ASSERT_EQ(pairs.size(), 2u);
    EXPECT_EQ(pairs[0].name, "000003");
    EXPECT_EQ(cv::norm(pairs[0].left, gray, cv::NORM_INF), 0);
    EXPECT_EQ(pairs[0].disparity_px.at<float>(3, 3), 5);
    EXPECT_NEAR(pairs[0].rig.value().baseline_m, 0.53, 1e-12) << "of the colour pair";
    EXPECT_FALSE(pairs[1].rig);
  }
  EXPECT_NEAR(read_image_pairs(folder.path() / "2012", 1).at(0).rig.value().baseline_m, 0.54, 1e-12);
  write("2012/training/image_1/000000_10.png", gray(cv::Rect(0, 0, 60, 48)));
  expect_part(refusal_of([&] { read_image_pairs(folder.path() / "2012", 1); }),
              "image_1/000000_10.png: must be 64x48 as 000000_10.png, is 60x48");
  std::filesystem::remove(folder.path() / "2012/training/image_1/000000_10.png");
  expect_part(refusal_of([&] { read_image_pairs(folder.path() / "2012", 1); }), "image_1/000000_10.png");

  for (const std::string scene : {"eth/scene/", "middlebury/scene/"})
    for (const char* name : {"im0.png", "im1.png"}) write(scene + name, colour);
  std::string pfm = "Pf\n64 48\n-1.0\n";
  for (int row = 47; row >= 0; --row)
    pfm.append(reinterpret_cast<const char*>(disparity.ptr(row)), 64 * sizeof(float));
  folder.write("eth_gt/scene/disp0GT.pfm", pfm);
  folder.write("middlebury/scene/disp0.pfm", pfm);
  for (const char* at : {"eth", "middlebury"})
    EXPECT_EQ(read_image_pairs(folder.path() / at, 1).at(0).disparity_px.at<float>(2, 2), 6.5F) << at;
}

}  // namespace
}  // namespace understory
