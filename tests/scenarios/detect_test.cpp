#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "perception/io/hit_files.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_pairs.hpp"

/// understory detect on images whose content is known.
namespace understory {
namespace {

namespace fs = std::filesystem;
using namespace support;

struct Detect : testing::Test {
  support::TemporaryFolder folder;
  StereoRig rig = support::house_rig("paper.yaml");
  std::string left = (folder.path() / "left").string(), right = (folder.path() / "right").string();
  std::string out = (folder.path() / "out").string();

  std::string folders() const { return left + " " + right; }
  std::string to_out() const { return " --rig paper --out " + out; }
  std::string found(const char* file) const { return support::content_of(fs::path(out) / file); }

  /// The same pairs in memory, no file and no command between.
  std::vector<FrameHits> expected(const std::vector<StereoFrame>& frames, const PushbroomConfig& rule) const {
    PushbroomStereo detector(rig, rule);
    std::vector<FrameHits> all;
    for (const StereoFrame& frame : frames)
      all.push_back({static_cast<std::int64_t>(all.size()), frame.t_ns, detector.detect(frame)});
    return all;
  }
};

std::size_t count_of(const std::vector<FrameHits>& frames) {
  std::size_t count = 0;
  for (const FrameHits& frame : frames) count += frame.hits.size();
  return count;
}

std::vector<Eigen::Vector3d> positions_in(const std::string& ply) {
  std::istringstream text(ply.substr(ply.find("end_header\n") + 11));
  std::vector<Eigen::Vector3d> positions;
  for (std::string line; std::getline(text, line);) {
    Eigen::Vector3d& p = positions.emplace_back();
    std::istringstream(line) >> p.x() >> p.y() >> p.z();
  }
  return positions;
}

TEST_F(Detect, FoldersGiveTheHitsThatThePairsGiveInMemory) {
  std::vector<StereoFrame> frames = support::planes(rig, 2);
  frames.push_back(support::planes(rig, 1, 1.5).front());
  support::write_pairs(folder.path(), frames, {"1", "2", "10"});
  // The rule, its default and its keys are those of a flight with this rig.
  for (const auto& [arguments, rule] :
       {std::pair("", tuned_pushbroom("paper")), std::pair(" --preset original", original_pushbroom()),
        std::pair(" --set perception.preset=original", original_pushbroom()),
        std::pair(" --preset robust", robust_pushbroom())}) {
    const auto hits = expected(frames, rule);
    ASSERT_GT(count_of(hits), 100u) << arguments;
    const ProgramRun outcome = expect_success(std::string("detect ") + folders() + to_out() + arguments);
    EXPECT_EQ(found("points.csv"), hits_to_csv(hits));
    EXPECT_EQ(found("points.ply"), hits_to_ply(hits));
    expect_part(outcome.text, std::to_string(count_of(hits)) + ", ");
    EXPECT_TRUE(fs::exists(fs::path(out) / "overlays/000002.png"));
    EXPECT_FALSE(fs::exists(fs::path(out) / "map.ply"));
  }
  expect_success("detect " + left + "/2.png " + right + "/2.png" + to_out());
  EXPECT_EQ(found("points.csv"), hits_to_csv(expected({frames[1]}, tuned_pushbroom("paper"))));
  EXPECT_FALSE(fs::exists(fs::path(out) / "overlays/000001.png"));  // of the run before
}

TEST_F(Detect, AFileOfKeysMeansWhatItMeansToAFlight) {
  const std::vector<StereoFrame> frames = support::planes(rig, 2);
  support::write_pairs(folder.path(), frames, {"1", "2"});
  const std::string keys = folder
                               .write("keys.yaml",
                                      "perception: {pushbroom: {minimum_edge_sum: 700}}\n"
                                      "autopilot: {map: {voxel_m: 0}}\n")
                               .string();
  PushbroomConfig rule = tuned_pushbroom("paper");
  rule.minimum_edge_sum = 700;
  expect_success("detect " + folders() + to_out() + " --with " + keys);
  EXPECT_EQ(found("points.csv"), hits_to_csv(expected(frames, rule)));
}

#ifdef UNDERSTORY_HAS_SIM
TEST_F(Detect, IsTheFlightsOwnDetector) {
  const std::string recorded = (folder.path() / "recorded").string();
  const auto flight = support::understory(
      "record forest --set time_limit_s=1 --set forest.clear_m=2 --set forest.square_metres_per_tree=8 "
      "--out " +
      recorded);
  ASSERT_LE(flight.status, 1) << flight.text;
  const std::string result = support::content_of(recorded + "/result.json");
  expect_success("detect " + recorded + " --out " + out);
  const std::string csv = found("points.csv");
  const auto hits = std::count(csv.begin(), csv.end(), '\n') - 1;
  EXPECT_GT(hits, 20);
  expect_part(result, "\"detections\": " + std::to_string(hits) + ",");
}
#endif

TEST_F(Detect, SeveralDepthsGiveTheHitsOfEach) {
  const std::vector<StereoFrame> frames = support::planes(rig, 2);
  support::write_pairs(folder.path(), frames, {"1", "2"});
  PushbroomConfig rule = tuned_pushbroom("paper");
  rule.depths_m = {rig.detection_depth_m, 4.0};
  rule.depths_score_limit = {0.25, 0.2};
  const ProgramRun outcome = expect_success("detect " + folders() + to_out() +
                                            " --set perception.depths_m=[4.8,4.0] "
                                            "--set perception.pushbroom.depths_score_limit=[0.25,0.2]");
  EXPECT_EQ(found("points.csv"), hits_to_csv(expected(frames, rule)));
  expect_part(outcome.text, "looked at         4.8");
  expect_part(outcome.text, "looked at         3.9");
}

TEST_F(Detect, AVideoGivesTheSameHitsAtItsTimes) {
  std::vector<StereoFrame> frames = support::planes(rig, 3);
  const std::string video = (folder.path() / "both.mkv").string();
  cv::VideoWriter writer(video, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('F', 'F', 'V', '1'), 20,
                         cv::Size(2 * rig.width_px, rig.height_px));  // a codec without loss
  if (!writer.isOpened()) GTEST_SKIP() << "FFmpeg has no FFV1 encoder here";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    cv::Mat both, picture;
    cv::hconcat(frames[i].left, frames[i].right, both);
    cv::cvtColor(both, picture, cv::COLOR_GRAY2BGR);
    writer.write(picture);
    frames[i].t_ns = static_cast<std::int64_t>(i) * 50'000'000;
  }
  writer.release();
  expect_success("detect " + video + " --video" + to_out());
  EXPECT_EQ(found("points.csv"), hits_to_csv(expected(frames, tuned_pushbroom("paper"))));
  cv::VideoCapture film((fs::path(out) / "overlay.mp4").string(), cv::CAP_FFMPEG);
  EXPECT_EQ(film.get(cv::CAP_PROP_FRAME_COUNT), 3);
  EXPECT_EQ(film.get(cv::CAP_PROP_FRAME_WIDTH), 2 * rig.width_px);
  EXPECT_FALSE(fs::exists(fs::path(out) / "overlays"));
}

TEST_F(Detect, PosesCarryHitsIntoTheWorld) {
  // A wall ahead, met at the detection depth with the camera level: every point lies in one plane.
  const std::vector<StereoFrame> frames = support::planes(rig, 2);
  support::write_pairs(folder.path(), frames, {"100.50", "101.00"});
  const double pitch_down_rad = 10.97 * std::numbers::pi / 180;  // as the rig is mounted
  const Eigen::Quaterniond q(Eigen::AngleAxisd(-pitch_down_rad, Eigen::Vector3d::UnitY()));
  std::ostringstream poses;
  poses.precision(12);
  for (const double t_s : {100.0, 101.0})  // 2 m/s along x
    poses << t_s << " " << 2 * (t_s - 100) << " 5 3 " << q.x() << " " << q.y() << " " << q.z() << " " << q.w()
          << "\n";
  const ProgramRun outcome =
      expect_success("detect " + folders() + to_out() + " --set autopilot.map.voxel_m=0 --poses " +
                     folder.write("poses.txt", poses.str()).string());
  const std::vector<Eigen::Vector3d> points = positions_in(found("map.ply"));
  const auto hits = expected(frames, tuned_pushbroom("paper"));
  ASSERT_EQ(points.size(), count_of(hits));
  const double depth_m = PushbroomStereo(rig, robust_pushbroom()).detection_depth_m();
  const Eigen::Vector3d camera = q * Eigen::Vector3d(0.10, 0.1765, 0);  // the paper rig's left camera
  std::size_t i = 0;
  for (const FrameHits& frame : hits) {
    const double flown_m = frame.frame == 0 ? 1.0 : 2.0;
    for (const StereoHit& hit : frame.hits) {
      const Eigen::Vector3d expected_world(flown_m + camera.x() + depth_m,
                                           5 + camera.y() - hit.position_camera.x(),
                                           3 + camera.z() - hit.position_camera.y());
      EXPECT_LT((points[i++] - expected_world).norm(), 2e-4);
    }
  }
}

TEST_F(Detect, FramesOutsideThePosesAreReportedAndLeftOutOfTheMap) {
  const std::vector<StereoFrame> frames = support::planes(rig, 3);
  support::write_pairs(folder.path(), frames, {"1.0", "2.0", "3.0"});
  const std::string poses =
      folder.write("poses.csv", "1500000000,0,0,0,1,0,0,0\n2500000000,0,0,0,1,0,0,0\n").string();
  const ProgramRun outcome =
      expect_success("detect " + folders() + to_out() + " --set autopilot.map.voxel_m=0 --poses " + poses);
  expect_part(outcome.text, "frames outside the poses' time, left out: 2");
  EXPECT_EQ(positions_in(found("map.ply")).size(), expected(frames, tuned_pushbroom("paper"))[1].hits.size());
  const std::string later = folder.write("later.csv", "9500000000,0,0,0,1,0,0,0\n").string();
  support::expect_refusal(
      "detect " + folders() + to_out() + " --poses " + later,
      "later.csv: the poses must cover the images' time, 1.000 to 3.000 s, they cover 9.500");
}

TEST_F(Detect, BadInputIsOneLineAndLeavesNoResult) {
  support::write_pairs(folder.path(), support::planes(rig, 3), {"a1", "a2", "a3"});
  const std::string detect = "detect " + folders() + to_out();
  const auto refuse = [](const std::string& arguments, const std::string& part) {
    support::expect_refusal(arguments, part);
  };
  refuse("detect", "INPUT");
  refuse("detect " + folders() + " --out " + out, "requires --rig");
  refuse("detect " + folders() + " --rig none --out " + out, "none: no such rig file");
  refuse(detect + " --size 752", "--size 752: must be WIDTHxHEIGHT");
  refuse(detect + " --depth 4000", "depth");
  refuse(detect + " --preset best", "--preset");
  refuse(detect + " --rectify cubic", "--rectify");
  refuse(detect + " --unit inch", "--unit");
  refuse(detect + " --set perception.pushbroom.edges=3", "perception.pushbroom.edges: unknown key");
  refuse(detect + " --set perception.depths_m=[4.8,900]",
         "perception.depths_m: the rig paper cannot look at 900 m");
  refuse(detect + " --set perception.pushbroom.depths_score_limit=[0.1,0.2,0.3]",
         "perception.pushbroom.depths_score_limit: must be empty or have one value a depth (2), has 3");
  refuse(detect + " --poses " + folder.write("p.txt", "0 0 0 0 0 0 0 1\n1 0 0\n").string(),
         "p.txt:2: expected");
  refuse(detect + " --poses " + folder.write("q.txt", "0 0 0 0 0 0 0 1\n").string(),
         "requires images with times");
  refuse("detect " + folders() + " --rig paper --out " + folder.write("taken", "").string() + "/out",
         "cannot write here");
  refuse("detect " + left + " " + (folder.path() / "none").string() + to_out(),
         "none: found no such file or folder");
  cv::imwrite(left + "/a1.png", cv::Mat(rig.height_px, rig.width_px, CV_16UC1, cv::Scalar(5)));
  refuse(detect, "left/a1.png: expected an 8-bit gray image, found 16-bit gray");
  cv::imwrite(left + "/a1.png", cv::Mat(480, 752, CV_8UC1, cv::Scalar(5)));
  cv::imwrite(right + "/a1.png", cv::Mat(480, 752, CV_8UC1, cv::Scalar(5)));
  refuse(detect, "left/a1.png: must be 376x240 as");
  std::string sizeless = support::content_of(fs::path(UNDERSTORY_SOURCE_DIR) / "models/rigs/raw/paper.xml");
  for (const char* line : {"<image_width>376</image_width>", "<image_height>240</image_height>"})
    sizeless.replace(sizeless.find(line), std::string(line).size(), "");
  refuse("detect " + left + "/a1.png " + right + "/a1.png --unit cm --out " + out + " --rig " +
             folder.write("sizeless.xml", sizeless).string(),
         "the principal point must lie near the middle of the 752x480 images");
  fs::remove(right + "/a2.png");
  refuse(detect, "left/a2.png: has no partner in");
  EXPECT_FALSE(fs::exists(fs::path(out)));
}

TEST_F(Detect, AFaultHalfWayLeavesTheRunBeforeAsItWas) {
  support::write_pairs(folder.path(), support::planes(rig, 3), {"a1", "a2", "a3"});
  expect_success("detect " + folders() + to_out());
  cv::imwrite(right + "/a3.png", cv::Mat(rig.height_px, rig.width_px, CV_8UC3, cv::Scalar(5)));
  const std::string before = support::content_of(fs::path(out) / "points.csv");
  for (const char* video : {"", " --video"})
    support::expect_refusal("detect " + folders() + to_out() + video,
                            "right/a3.png: expected an 8-bit gray image");
  EXPECT_EQ(support::content_of(fs::path(out) / "points.csv"), before);  // the run before, whole
  EXPECT_TRUE(fs::exists(fs::path(out) / "overlays/000002.png"));
  expect_success("detect " + left + "/a1.png " + right + "/a1.png" + to_out());
  EXPECT_TRUE(fs::exists(fs::path(out) / "overlays/000000.png"));
  EXPECT_FALSE(fs::exists(fs::path(out) / "overlays/000002.png"));  // it must not pass for this run's
}

}  // namespace
}  // namespace understory
