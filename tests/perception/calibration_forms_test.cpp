#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core/persistence.hpp>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/calibration/write_calibration.hpp"
#include "perception/rectification/rectify.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/temporary_folder.hpp"

/// Calibrations in the forms of other programs, written by hand from their documentation.
namespace understory {
namespace {

using namespace support;
using CalibrationForms = FolderTest;

const std::filesystem::path fisheye_file =
    std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "tests/data/fisheye_camchain.yaml";

const std::string kalibr_text =
    "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [-0.17, 0.05, 0.001, -0.0005]\n"
    "  distortion_model: radtan\n  intrinsics: [534.8, 534.9, 335.7, 240.7]\n  resolution: [640, 480]\n"
    "cam1:\n  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.12]\n  - [0.0, 1.0, 0.0, 0.0]\n  - [0.0, 0.0, 1.0, 0.0]\n"
    "  - [0.0, 0.0, 0.0, 1.0]\n  camera_model: pinhole\n  distortion_coeffs: [-0.16, 0.05, 0.001, -0.0005]\n"
    "  distortion_model: radtan\n  intrinsics: [534.8, 534.8, 335.7, 240.7]\n  resolution: [640, 480]\n"
    "  rostopic: /cam1/image_raw\n";

std::string ros_text(double shift, const std::string& model = "plumb_bob",
                     const std::string& coefficients = "-0.17, 0.05, 0.001, -0.0005, 0.") {
  return "image_width: 640\nimage_height: 480\ncamera_name: eye\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
         "  data: [534.8, 0., 335.7, 0., 534.9, 240.7, 0., 0., 1.]\ndistortion_model: " +
         model + "\ndistortion_coefficients:\n  rows: 1\n  cols: " +
         std::to_string(1 + std::ranges::count(coefficients, ',')) + "\n  data: [" + coefficients +
         "]\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1., 0., 0., 0., 1., 0., 0., 0., 1.]\n"
         "projection_matrix:\n  rows: 3\n  cols: 4\n  data: [525., 0., 340., " +
         std::to_string(shift) + ", 0., 525., 240., 0., 0., 0., 1., 0.]\n";
}

const std::string kitti_text =
    "P0: 700 0 600 0 0 700 170 0 0 0 1 0\nP1: 700 0 600 -378 0 700 170 0 0 0 1 0\n"
    "P2: 700 0 600 42 0 700 170 0 0 0 1 0\nP3: 700 0 600 -329 0 700 170 0 0 0 1 0\n"
    "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.3\n";
const std::string kitti_raw_text =
    "calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.950000e-02\nS_00: 1.392e+03 5.12e+02\n"
    "K_00: 984 0 690 0 980 233 0 0 1\nD_00: -0.37 0.2 0.001 0.002 -0.07\nR_00: 1 0 0 0 1 0 0 0 1\n"
    "T_00: 0 0 0\nS_rect_00: 1.242e+03 3.75e+02\nR_rect_00: 1 0 0 0 1 0 0 0 1\n"
    "P_rect_00: 721.5 0 609.6 0 0 721.5 172.9 0 0 0 1 0\n"
    "P_rect_01: 721.5 0 609.6 -387.6 0 721.5 172.9 0 0 0 1 0\n";
const std::string middlebury_text =
    "cam0=[1000 0 320; 0 1000 240; 0 0 1]\ncam1=[1000 0 350; 0 1000 240; 0 0 1]\ndoffs=30\nbaseline=200\n"
    "width=640\nheight=480\nndisp=100\nisint=0\nvmin=10\nvmax=90\ndyavg=0\ndymax=0\n";

CalibratedRig read(const std::filesystem::path& path, const CalibrationOptions& options = {}) {
  return read_calibrated_rig(path, options);
}

/// By Kannala & Brandt's formula, or by that of Brown: from the raw camera's axes into its image.
cv::Point2d pixel_by_formula(const CameraCalibration& camera, const cv::Vec3d& point) {
  const std::vector<double>& k = camera.distortion;
  const double x = point[0] / point[2], y = point[1] / point[2], r = std::hypot(x, y);
  cv::Point2d bent;
  if (camera.lens == LensModel::equidistant) {
    const double t = std::atan(r), t2 = t * t;
    const double scale =
        t * (1 + k[0] * t2 + k[1] * t2 * t2 + k[2] * std::pow(t, 6) + k[3] * std::pow(t, 8)) / r;
    bent = {scale * x, scale * y};
  } else {
    const double radial = 1 + k[0] * r * r + k[1] * std::pow(r, 4);
    bent = {radial * x + 2 * k[2] * x * y + k[3] * (r * r + 2 * x * x),
            radial * y + k[2] * (r * r + 2 * y * y) + 2 * k[3] * x * y};
  }
  return {camera.camera_matrix(0, 0) * bent.x + camera.camera_matrix(0, 2),
          camera.camera_matrix(1, 1) * bent.y + camera.camera_matrix(1, 2)};
}

/// The stack's rectification takes each pixel from where the formula puts the ray that it shows.
void expect_rectified_by_formula(const StereoCalibration& calibration) {
  for (const CameraCalibration* camera : {&calibration.left, &calibration.right}) {
    const std::vector<std::int16_t> places =
        nearest_places(*camera, calibration.width_px, calibration.height_px);
    const cv::Matx34d& P = camera->projection;
    for (int row = 0; row < calibration.height_px; row += 7)
      for (int column = 0; column < calibration.width_px; column += 7) {
        const cv::Vec3d rectified((column - P(0, 2)) / P(0, 0), (row - P(1, 2)) / P(1, 1), 1);
        const cv::Point2d expected = pixel_by_formula(*camera, camera->rectification.t() * rectified);
        const std::size_t at = 2 * static_cast<std::size_t>(row * calibration.width_px + column);
        ASSERT_NEAR(places[at], expected.x, 0.51) << column << ", " << row;
        ASSERT_NEAR(places[at + 1], expected.y, 0.51) << column << ", " << row;
      }
  }
}

/// A far point and a near one lie where rectified pinhole cameras see them, by the formula's raw pixels.
TEST_F(CalibrationForms, KalibrsCamchain) {
  folder.write("camchain.yaml", kalibr_text);
  for (const std::filesystem::path& path : {folder.path() / "camchain.yaml", folder.path()}) {
    const CalibratedRig found = read(path);
    EXPECT_NEAR(found.rig.baseline_m, 0.12, 1e-12);
    EXPECT_EQ(found.rig.width_px, 640);
    EXPECT_EQ(found.calibration->left.camera_matrix, cv::Matx33d(534.8, 0, 335.7, 0, 534.9, 240.7, 0, 0, 1));
    EXPECT_EQ(found.calibration->right.distortion, (std::vector<double>{-0.16, 0.05, 0.001, -0.0005}));
    expect_rectified_by_formula(*found.calibration);
  }
}

TEST_F(CalibrationForms, FisheyeLensesOfKalibrOfRosAndOfEuroc) {
  const CalibratedRig found = read(fisheye_file);
  EXPECT_EQ(found.calibration->left.lens, LensModel::equidistant);
  EXPECT_NEAR(found.rig.baseline_m, std::sqrt(0.04 + 1e-6 + 4e-6), 1e-9);
  EXPECT_GT(found.rig.focal_px, 60);
  expect_rectified_by_formula(*found.calibration);

  folder.write("left.yaml", ros_text(0, "equidistant", "0.012, -0.004, 0.003, -0.001"));
  folder.write("right.yaml", ros_text(-63, "equidistant", "0.012, -0.004, 0.003, -0.001"));
  const CalibratedRig ros = read(folder.path());
  EXPECT_EQ(ros.calibration->right.lens, LensModel::equidistant);
  expect_rectified_by_formula(*ros.calibration);
}

TEST_F(CalibrationForms, RosCameraInfo) {
  folder.write("left.yaml", ros_text(0));
  folder.write("right.yaml", ros_text(-63));
  for (const char* name : {"", "left.yaml", "right.yaml"}) {
    const CalibratedRig found = read(folder.path() / name);
    EXPECT_NEAR(found.rig.baseline_m, 63.0 / 525, 1e-12);
    EXPECT_EQ(found.rig.focal_px, 525);
    EXPECT_EQ(found.rig.center_left_x_px, 340);
    EXPECT_EQ(found.calibration->left.distortion, (std::vector<double>{-0.17, 0.05, 0.001, -0.0005, 0}));
    expect_rectified_by_formula(*found.calibration);
  }
  // A chessboard of 25 mm whose squares were taken for units: 0.12 m are 4.8 squares.
  folder.write("right.yaml", ros_text(-63 / 0.025));
  expect_line(refusal_of([&] { read(folder.path()); }), folder.path().string() + ": baseline: ", "--unit");
  CalibrationOptions squares;
  squares.meters_per_unit = 0.025;
  EXPECT_NEAR(read(folder.path(), squares).rig.baseline_m, 63.0 / 525, 1e-12);
}

TEST_F(CalibrationForms, Kitti) {
  folder.write("calib.txt", kitti_text);
  CalibrationOptions options;
  options.width_px = 1241, options.height_px = 376;
  for (const char* name : {"calib.txt", ""}) {
    const CalibratedRig found = read(folder.path() / name, options);
    EXPECT_FALSE(found.calibration);
    EXPECT_EQ(found.rig.focal_px, 700);
    EXPECT_NEAR(found.rig.baseline_m, 378.0 / 700, 1e-12);
  }
  folder.write("calib.txt", kitti_text.substr(kitti_text.find("P2:")));
  EXPECT_NEAR(read(folder.path(), options).rig.baseline_m, (42.0 + 329) / 700, 1e-12);
  folder.write("calib.txt", kitti_raw_text);
  const CalibratedRig raw = read(folder.path());
  EXPECT_EQ(raw.rig.width_px, 1242);
  EXPECT_NEAR(raw.rig.baseline_m, 387.6 / 721.5, 1e-12);
}

TEST_F(CalibrationForms, Middlebury) {
  folder.write("calib.txt", middlebury_text);
  const CalibratedRig found = read(folder.path());
  EXPECT_EQ(found.rig.focal_px, 1000);
  EXPECT_NEAR(found.rig.baseline_m, 0.2, 1e-12);
  EXPECT_EQ(found.rig.infinity_disparity_px(), -30);
  EXPECT_EQ(found.rig.height_px, 480);
}

/// XML, YAML and JSON, with numbers or bytes, plain or packed: OpenCV writes them, every bit comes back.
TEST_F(CalibrationForms, OpenCvInAllItsClothes) {
  CalibrationOptions options;
  options.meters_per_unit = 0.01;
  const CalibratedRig expected = read(house_rigs / "raw/paper.xml", options);
  const StereoCalibration& pair = *expected.calibration;
  for (const char* name : {"a.xml", "a.yml", "a.json", "a.xml.gz", "a.yml.gz", "a.json.gz"})
    for (const int packing : {0, static_cast<int>(cv::FileStorage::WRITE_BASE64)}) {
      cv::FileStorage storage(path(name), cv::FileStorage::WRITE | packing);
      storage << "image_width" << 376 << "image_height" << 240;
      for (const auto& [number, camera] : {std::pair("1", &pair.left), {"2", &pair.right}})
        storage << std::string("M") + number << cv::Mat(camera->camera_matrix) << std::string("D") + number
                << cv::Mat(camera->distortion).t() << std::string("R") + number
                << cv::Mat(camera->rectification) << std::string("P") + number << cv::Mat(camera->projection);
      storage.release();
      const CalibratedRig found = read(folder.path() / name);
      EXPECT_EQ(found.rig.focal_px, expected.rig.focal_px) << name;
      EXPECT_EQ(found.rig.baseline_m, expected.rig.baseline_m) << name;
      EXPECT_EQ(found.calibration->left.distortion, pair.left.distortion) << name;
      EXPECT_EQ(found.calibration->right.camera_matrix, pair.right.camera_matrix) << name;
    }
}

TEST_F(CalibrationForms, OpenCvsFisheyeIsOneWhereItsFileSaysSo) {
  cv::FileStorage storage(path("wide.yml"), cv::FileStorage::WRITE);
  const cv::Mat K = (cv::Mat_<double>(3, 3) << 190, 0, 188, 0, 190, 120, 0, 0, 1);
  const cv::Mat D = (cv::Mat_<double>(4, 1) << 0.012, -0.004, 0.003, -0.001);
  storage << "image_width" << 376 << "image_height" << 240 << "fisheye_model" << 1 << "M1" << K << "D1" << D
          << "M2" << K << "D2" << D << "R" << cv::Mat::eye(3, 3, CV_64F) << "T"
          << (cv::Mat_<double>(3, 1) << -0.2, 0, 0);
  storage.release();
  const CalibratedRig found = read(path("wide.yml"));
  EXPECT_EQ(found.calibration->right.lens, LensModel::equidistant);
  expect_rectified_by_formula(*found.calibration);
}

const std::string base64_text =
    "%YAML:1.0\n---\nM1: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: !!binary |\n"
    "      MWQgICAgICAgICAgICAgICAgICAgICAg\n";

/// Each wrong file ends in one line that says what was expected where.
TEST_F(CalibrationForms, WrongFilesEndInOneLine) {
  struct Wrong {
    const char* name;
    std::string text, from, to, expected;
  };
  const std::vector<Wrong> all{
      {"k.yaml", kalibr_text, "pinhole", "omni", ":2: cam0.camera_model: expected pinhole, found 'omni'"},
      {"k.yaml", kalibr_text, "radtan", "fov", ":4: cam0.distortion_model: expected radtan or equidistant"},
      {"k.yaml", kalibr_text, "radtan", "equidistant",
       ":15: cam1.distortion_model: must be that of the left camera"},
      {"k.yaml", kalibr_text, ", -0.0005]", "]", ":3: cam0.distortion_coeffs: must be a list of 4 numbers"},
      {"k.yaml", kalibr_text, "[534.8,", "[4.8,",
       ":5: cam0.intrinsics: focal lengths must be from 10 to 20000 px"},
      {"k.yaml", kalibr_text, "[640, 480]", "[640, 481]",
       ":17: cam1.resolution: must be that of the left camera"},
      {"k.yaml", kalibr_text, ", -0.12]", ", 0.12]",
       "cam1.T_cn_cnm1: the right camera must lie to the right of the left one"},
      {"k.yaml", kalibr_text, ", -0.12]", "]", "cam1.T_cn_cnm1: must be a list of 16 numbers, found 15"},
      {"k.yaml", kalibr_text, "[1.0, 0.0, 0.0, -", "[1.1, 0.0, 0.0, -", "cam1.T_cn_cnm1: must be a rotation"},
      {"k.yaml", kalibr_text, "cam1:", "cam2:", ": cam1: missing"},
      {"k.yaml", kalibr_text, "  rostopic", "  shutter", ":18: cam1.shutter: "},
      {"left.yaml", ros_text(0), "rows: 3", "rows: 2", ":5: camera_matrix.rows: "},
      {"left.yaml", ros_text(0), "plumb_bob", "thin_prism", "expected plumb_bob or rational_polynomial or"},
      {"left.yaml", ros_text(0), "cols: 5", "cols: 4", "distortion_coefficients.cols: "},
      {"left.yaml", ros_text(0), "[534.8, 0.", "[534.8, 1.", ": camera_matrix: must have the form"},
      {"left.yaml", ros_text(0), "[534.8, 0., 3", "[534.8, 0., 93", "principal point: of the raw image"},
      {"left.yaml", ros_text(0), "[1., 0., 0., 0.", "[2., 0., 0., 0.",
       ": rectification_matrix: must be a rotation"},
      {"left.yaml", ros_text(0), "[525., 0.", "[525., 7.", ": projection_matrix: must have the form"},
      {"left.yaml", ros_text(0), "image_width: 640", "image_width: 6", ":1: image_width: "},
      {"left.yaml", ros_text(0), "camera_name: eye", "binning_x: 2", ": binning_x: "},
      {"left.yaml", ros_text(0), "camera_name: eye", "lens: wide", ": lens: "},
      {"left.yaml", ros_text(0), "340., 0.0", "340., -5.0", "must be 0 for the left camera"},
      {"c.txt", kitti_text, "P1: 700", "P1: 701", "the focal length must be the same"},
      {"c.txt", kitti_text, "P1: 700 0", "P1: 700 x",
       ":2: P1: must be a number from -1000000000 to 1000000000, found 'x'"},
      {"c.txt", kitti_text, " 0 0 1 0\nP1", " 0 0 1\nP1", ":1: P0: must be a list of 12 numbers, found 11"},
      {"c.txt", kitti_text, "-378", "378", "the right camera must lie to the right"},
      {"c.txt", kitti_text, "Tr:", "Tx:", ":5: Tx: unknown key"},
      {"c.txt", kitti_text, "Tr:", "P0:", ":5: P0: this key is given twice"},
      {"c.txt", kitti_text, "Tr: ", "Tr ", ":5: expected KEY: and numbers"},
      {"c.txt", kitti_raw_text, "S_rect_00: 1.242e+03", "S_rect_00: 1e+05",
       ":8: S_rect_00: must be a number from 32 to 8192"},
      {"m.txt", middlebury_text, "baseline=200", "baseline=wide", ":4: baseline: must be a number"},
      {"m.txt", middlebury_text, "baseline=200", "baseline=20000", ": baseline in m: "},
      {"m.txt", middlebury_text, "doffs=30", "doffs=31", ":3: doffs: must be the column"},
      {"m.txt", middlebury_text, "0 1000 240; 0 0 1]\nd", "0 1000 241; 0 0 1]\nd",
       ":2: cam1: must have the focal"},
      {"m.txt", middlebury_text, "cam1=[1000 0", "cam1=[1000 3", ":2: cam1: must have the form"},
      {"m.txt", middlebury_text, "ndisp", "disparities", ":7: disparities: unknown key"},
      {"m.txt", middlebury_text, "height=480\n", "", ": height: missing"},
      {"m.txt", middlebury_text, "width=640", "cam0=640", ":5: cam0: this key is given twice"},
      {"b.yml", base64_text, "MWQg", "MWYg", ":7: M1.data: must be 9 numbers of type d in base64"},
      {"b.yml", base64_text, "ICAg\n", "IC*g\n", ":7: M1.data: must be 9 numbers of type d in base64"},
      {"p.xml.gz", "\x1f\x8b\x08", "\x08", "\x08 no more", ": not whole: its gzip data are broken"},
  };
  for (const Wrong& wrong : all) {
    folder.write("right.yaml", ros_text(-63));
    const std::size_t at = wrong.text.find(wrong.from);
    ASSERT_NE(at, std::string::npos) << wrong.from;
    std::string text = wrong.text;
    const auto file = folder.write(wrong.name, text.replace(at, wrong.from.size(), wrong.to));
    CalibrationOptions options;
    if (wrong.name == std::string("c.txt") && wrong.text == kitti_text)
      options.width_px = 1241, options.height_px = 376;
    expect_line(refusal_of([&] { read(file, options); }), folder.path().string(), wrong.expected);
  }
}

TEST_F(CalibrationForms, UnitsAreForFormsThatStateNone) {
  CalibrationOptions options;
  options.meters_per_unit = 0.01;
  folder.write("k.yaml", kalibr_text);
  folder.write("m.txt", middlebury_text);
  folder.write("c.txt", kitti_raw_text);
  for (const char* name : {"k.yaml", "m.txt", "c.txt"})
    expect_line(refusal_of([&] { read(folder.path() / name, options); }),
                path(name) + ": unit: ", "--unit is for OpenCV's and ROS's files");
  expect_line(refusal_of([&] { read(house_rigs / "long.yaml", options); }),
              (house_rigs / "long.yaml").string() + ": unit: ", "in metres");
}

TEST_F(CalibrationForms, OneCameraOfAPairIsNotEnough) {
  const auto ros = folder.write("alone/front.yaml", ros_text(0));
  expect_line(refusal_of([&] { read(ros); }), ros.string(), "name the folder that holds the files of both");
  const auto euroc = folder.write("sensor.yaml", "T_BS:\n  cols: 4\ndistortion_coefficients: [0]\n");
  expect_line(refusal_of([&] { read(euroc); }), euroc.string(), "name the folder that holds cam0 and cam1");
}

void expect_near(const cv::Mat& a, const cv::Mat& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  EXPECT_LT(cv::norm(a, b, cv::NORM_INF), 1e-9) << what << "\n" << a << "\n" << b;
}

void expect_same_rig(const StereoRig& a, const StereoRig& b) {
  EXPECT_EQ(cv::Size(a.width_px, a.height_px), cv::Size(b.width_px, b.height_px));
  EXPECT_NEAR(a.focal_px, b.focal_px, 1e-9);
  EXPECT_NEAR(a.baseline_m, b.baseline_m, 1e-9);
  EXPECT_NEAR(a.center_left_x_px, b.center_left_x_px, 1e-9);
  EXPECT_NEAR(a.center_right_x_px, b.center_right_x_px, 1e-9);
  EXPECT_NEAR(a.center_y_px, b.center_y_px, 1e-9);
}

void expect_same_cameras(const CalibratedRig& a, const CalibratedRig& b) {
  ASSERT_EQ(a.calibration.has_value(), b.calibration.has_value());
  if (!a.calibration) return;
  for (const auto side : {&StereoCalibration::left, &StereoCalibration::right}) {
    const CameraCalibration &one = (*a.calibration).*side, &other = (*b.calibration).*side;
    EXPECT_EQ(one.lens, other.lens);
    expect_near(cv::Mat(one.camera_matrix), cv::Mat(other.camera_matrix), "camera matrix");
    std::vector<double> k = one.distortion, other_k = other.distortion;
    k.resize(8), other_k.resize(8);
    expect_near(cv::Mat(k), cv::Mat(other_k), "distortion");
    expect_near(cv::Mat(one.rectification), cv::Mat(other.rectification), "rectification");
    expect_near(cv::Mat(one.projection), cv::Mat(other.projection), "projection");
  }
}

/// Each form of each calibration, written and read back, is the same to 1e-9.
TEST_F(CalibrationForms, ThereAndBack) {
  const std::filesystem::path models = std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models/rigs";
  folder.write("camchain.yaml", kalibr_text);
  folder.write("ros/left.yaml", ros_text(0, "rational_polynomial", "1, 2, .1, .2, .3, 1, 2, .5"));
  folder.write("ros/right.yaml", ros_text(-63));
  folder.write("kitti/calib.txt", kitti_raw_text);
  folder.write("middlebury/calib.txt", middlebury_text);
  const std::filesystem::path at = folder.path();
  for (const std::filesystem::path& source :
       {at / "camchain.yaml", fisheye_file, at / "ros", at / "kitti", at / "middlebury", models / "long.yaml",
        models / "raw/long.xml"}) {
    SCOPED_TRACE(source.string());
    const CalibratedRig first = read(source);
    const auto there_and_back = [&](CalibrationForm form, const std::string& out) {
      for (const auto& [file, text] : calibration_texts(first, form, at / "out" / out))
        folder.write(std::filesystem::relative(file, at).string(), text);
      return read(at / "out" / out);
    };
    const CalibratedRig rig = there_and_back(CalibrationForm::rig_file, "rig.yaml");
    expect_same_rig(rig.rig, first.rig);
    EXPECT_LT((rig.rig.T_body_camera.matrix() - first.rig.T_body_camera.matrix()).cwiseAbs().maxCoeff(),
              1e-9);
    if (first.calibration) expect_same_cameras(read(raw_file_of(at / "out/rig.yaml")), first);
    for (const char* out : {"cv.xml", "cv.yaml", "cv.yml", "cv.json"}) {
      const CalibratedRig opencv = there_and_back(CalibrationForm::opencv, out);
      expect_same_rig(opencv.rig, first.rig);
      expect_same_cameras(opencv, first);
    }
    const CalibratedRig ros = there_and_back(CalibrationForm::ros, "ros");
    expect_same_rig(ros.rig, first.rig);
    expect_same_cameras(ros, first);
    if (source == at / "ros" || source == models / "raw/long.xml") continue;  // rectified by their makers
    const CalibratedRig kalibr = there_and_back(CalibrationForm::kalibr, "camchain.yaml");
    expect_same_rig(kalibr.rig, first.rig);
    expect_same_cameras(kalibr, first);
  }
}

/// Kalibr's form does not say how a pair is rectified: of the real rig, the raw cameras come back.
TEST_F(CalibrationForms, KalibrKeepsTheRawCamerasOfAPairThatItsMakerRectified) {
  const std::filesystem::path source =
      std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models/rigs/raw/long.xml";
  const CalibratedRig first = read(source);
  CalibratedRig short_lens = first;
  short_lens.calibration->left.distortion.resize(4);
  short_lens.calibration->right.distortion.resize(4);
  for (const auto& [file, text] :
       calibration_texts(short_lens, CalibrationForm::kalibr, folder.path() / "k.yaml"))
    folder.write(file.filename().string(), text);
  const CalibratedRig back = read(folder.path() / "k.yaml");
  EXPECT_NEAR(back.rig.baseline_m, first.rig.baseline_m, 1e-9);
  const auto turn = [](const CalibratedRig& rig) {
    return rig.calibration->right.rectification.t() * rig.calibration->left.rectification;
  };
  expect_near(cv::Mat(turn(back)), cv::Mat(turn(first)), "rotation from the left camera to the right");
  expect_line(refusal_of([&] { calibration_texts(first, CalibrationForm::kalibr, "k.yaml"); }),
              "k.yaml: distortion_coeffs: ", "OpenCV's and ROS's");
  expect_line(refusal_of([&] { calibration_texts(first, CalibrationForm::opencv, "k.txt"); }),
              "k.txt: ", ".xml");
}

/// A EuRoC body has x up and z ahead, where yaw and roll cannot be told apart.
TEST_F(CalibrationForms, RigFilesHoldAnyMounting) {
  CalibratedRig calibrated = read(std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models/rigs/long.yaml");
  Eigen::Matrix3d up_and_ahead;  // columns: the camera's axes right, down, ahead
  up_and_ahead << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  for (const double turn : {0.0, 1e-12, 1e-6, 0.01, 1.0, 3.0})
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.6, 0, 0.8), Eigen::Vector3d(0, 1, 0)}) {
      calibrated.rig.T_body_camera.linear() = up_and_ahead * Eigen::AngleAxisd(turn, axis).toRotationMatrix();
      folder.write("rig.yaml",
                   calibration_texts(calibrated, CalibrationForm::rig_file, "rig.yaml").front().text);
      const Eigen::Matrix4d back = read_rig(folder.path() / "rig.yaml").T_body_camera.matrix();
      EXPECT_LT((back - calibrated.rig.T_body_camera.matrix()).cwiseAbs().maxCoeff(), 1e-9) << turn;
    }
}

}  // namespace
}  // namespace understory
