#include "perception/io/pose_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "perception/io/text_table.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using support::refusal_of;

constexpr std::int64_t s = 1'000'000'000;

/// A steady turn about a tilted axis on a straight line: between any two samples the interpolation is exact.
TimedPose steady(double t_s) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  TimedPose pose;
  pose.t_ns = std::llround(t_s * 1e9);
  pose.T_world_body = Eigen::Translation3d(Eigen::Vector3d(3, -1, 2) + t_s * Eigen::Vector3d(9, 0.5, -0.25)) *
                      Eigen::AngleAxisd(0.8 * t_s, axis);
  return pose;
}

TEST(PoseAt, FollowsASteadyTurnExactly) {
  const std::vector<TimedPose> poses{steady(1), steady(1.5), steady(3.25)};
  for (const double t_s : {1.0, 1.1, 1.5, 1.875, 2.5, 3.2, 3.25}) {
    const auto pose = pose_at(poses, std::llround(t_s * 1e9));
    ASSERT_TRUE(pose) << t_s;
    EXPECT_TRUE(pose->isApprox(steady(t_s).T_world_body, 1e-12)) << t_s;
  }
}

TEST(PoseAt, TurnsTheShorterWayWhateverTheQuaternionsSigns) {
  // 170 and -170 degrees about z lie 20 degrees apart, and q and -q are one attitude.
  const auto poses =
      parse_poses("0 0 0 0 0 0 0.99619470 0.08715574\n1 0 0 0 0 0 -0.99619470 0.08715574\n", "t");
  const Eigen::Matrix3d half_way = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_TRUE(pose_at(poses, s / 2)->linear().isApprox(half_way, 1e-7));
  const auto signs = parse_poses("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 -1\n", "t");
  EXPECT_TRUE(pose_at(signs, s / 3)->isApprox(Eigen::Isometry3d::Identity(), 1e-12));
}

TEST(PoseAt, KnowsNothingOutsideItsTime) {
  const std::vector<TimedPose> poses{steady(1), steady(2)};
  EXPECT_FALSE(pose_at(poses, s - 1001));
  EXPECT_FALSE(pose_at(poses, 2 * s + 1001));
  EXPECT_FALSE(pose_at({}, s));
  // Seconds that went through a double.
  EXPECT_TRUE(pose_at(poses, s - 200)->isApprox(steady(1).T_world_body));
  EXPECT_TRUE(pose_at(poses, 2 * s + 200)->isApprox(steady(2).T_world_body));
  EXPECT_TRUE(pose_at({steady(1)}, s)->isApprox(steady(1).T_world_body));
}

TEST(PoseFile, BothFormsSayTheSame) {
  const support::TemporaryFolder folder;
  const std::filesystem::path tum = folder.write("poses.txt",
                                                 "# timestamp tx ty tz qx qy qz qw\n"
                                                 "1403715273.262142976 1 2 3 0.5 -0.5 0.5 0.5\n\n"
                                                 "  1403715274.5\t-1 2e-1 3 0 0 0 1\r\n");
  const std::filesystem::path euroc = folder.write("data.csv",
                                                   "\xEF\xBB\xBF#timestamp, p_RS_R_x [m], ...\r\n"
                                                   "1403715273262142976,1,2,3,0.5,0.5,-0.5,0.5,9,9,9\r\n"
                                                   "1403715274500000000, -1, 0.2, 3, 1, 0, 0, 0\r\n");
  const auto from_tum = read_poses(tum), from_euroc = read_poses(euroc);
  ASSERT_EQ(from_tum.size(), 2u);
  ASSERT_EQ(from_euroc.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(from_tum[i].t_ns, from_euroc[i].t_ns);
    EXPECT_TRUE(from_tum[i].T_world_body.isApprox(from_euroc[i].T_world_body, 1e-12));
  }
  EXPECT_EQ(from_tum[0].t_ns, 1403715273262142976);
  EXPECT_TRUE(from_tum[0].T_world_body.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  // 120 degrees about (1, -1, 1): x goes to z, z to -y, y to -x.
  const Eigen::Matrix3d R = from_tum[0].T_world_body.linear();
  Eigen::Matrix3d expected;
  expected << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  EXPECT_TRUE(R.isApprox(expected, 1e-12)) << R;
}

TEST(PoseFile, SecondsKeepTheirNanoseconds) {
  EXPECT_EQ(seconds_in("1403715273.262142976"), 1403715273262142976);
  EXPECT_EQ(seconds_in("1403715273.2621429764"), 1403715273262142976);
  EXPECT_EQ(seconds_in("0.9999999996"), s);
  EXPECT_EQ(seconds_in("12"), 12 * s);
  EXPECT_EQ(seconds_in("12."), 12 * s);
  EXPECT_EQ(seconds_in("1.25e+01"), 12 * s + s / 2);
  for (const char* none : {"", ".", "-1", "x", "1,5", "nan", "inf", "1e300", "99999999999", "1 2"})
    EXPECT_FALSE(seconds_in(none)) << none;
}

TEST(PoseFile, ColumnsGoByTheirNames) {
  const auto attitude = [](const std::string& text) -> Eigen::Vector4d {
    return Eigen::Quaterniond(parse_poses(text, "p").front().T_world_body.linear()).coeffs();  // x y z w
  };
  const Eigen::Vector4d turned(0, 0, 0.6, 0.8);
  for (const char* text :
       {"#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_x [],q_RS_y [],q_RS_z [],q_RS_w []\n"
        "5,1,2,3,0,0,.6,.8\n",
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
        "v_RS_R_x [m s^-1]\n5,1,2,3,.8,0,0,.6,9\n",
        "# timestamp tx ty tz qw qx qy qz\n5 1 2 3 .8 0 0 .6\n",
        "# timestamp [s], tx [m], ty [m], tz [m], qw, qx, qy, qz\n5 1 2 3 .8 0 0 .6\n",
        "\"t_s\",\"x_m\",\"y_m\",\"z_m\",\"qx\",\"qy\",\"qz\",\"qw\"\n5,1,2,3,0,0,.6,.8\n",
        "# poses made by my own tool in 2021\n5 1 2 3 0 0 .6 .8\n"})
    EXPECT_TRUE(attitude(text).isApprox(turned, 1e-12)) << text;
  EXPECT_EQ(parse_poses("#timestamp [s],x,y,z,qw,qx,qy,qz\n5.5,1,2,3,1,0,0,0\n", "p")[0].t_ns, 5'500'000'000);
  for (const char* text : {"#a,b,c,d,e,f,g,h\n5,1,2,3,1,0,0,0\n", "#t,x,y,z,qx,qy,qz,qz\n5,1,2,3,0,0,0,1\n",
                           "#t,x [mm],y [mm],z [mm],qw,qx,qy,qz\n5,1,2,3,1,0,0,0\n"})
    EXPECT_EQ(refusal_of([&] { parse_poses(text, "p"); }).find("p:1: "), 0u) << text;
}

TEST(PoseFile, ReadsWhatOthersWrite) {
  // ORB-SLAM3's SaveTrajectoryEuRoC; fr2_desk of TUM's data sets, whose times repeat.
  EXPECT_EQ(parse_poses("1000000000100000000.000000 1 2 3 0 0 0 1\n", "p")[0].t_ns, 1000000000100000000);
  const std::string twice = "0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n";
  EXPECT_EQ(parse_poses(twice, "p", Repeats::skipped).size(), 2u);
  EXPECT_EQ(refusal_of([&] { parse_poses(twice, "p"); }), "p:2: times must increase from line to line");
}

TEST(PoseFile, NamesTheLineOfEveryFault) {
  const auto complaint = [](const std::string& text) { return refusal_of([&] { parse_poses(text, "p"); }); };
  const std::string good = "0 0 0 0 0 0 0 1\n";
  EXPECT_EQ(complaint(good + "1 0 0 0 0 0 0\n").find("p:2: expected 't tx"), 0u);
  EXPECT_EQ(complaint(good + "1 0 0 0 0 0 0 1 0\n").find("p:2: expected 't tx"), 0u);
  EXPECT_EQ(complaint(good + "1 0 0 0 0 0 zero 1\n").find("p:2: expected 't tx"), 0u);
  EXPECT_EQ(complaint(good + "1 0 nan 0 0 0 0 1\n").find("p:2: expected 't tx"), 0u);
  EXPECT_EQ(complaint(good + "# all is well\n1 0 0 0 0 0 0 0.5\n"), "p:3: the quaternion must have length 1");
  EXPECT_EQ(complaint(good + "1 0 0 0 0 0 0 0\n"), "p:2: the quaternion must have length 1");
  EXPECT_EQ(complaint(good + "1 1e9 0 0 0 0 0 1\n"), "p:2: the position must be within 1e8 m");
  EXPECT_EQ(complaint(good + good), "p:2: times must increase from line to line");
  EXPECT_EQ(complaint("-1 0 0 0 0 0 0 1\n").find("p:1: expected 't tx"), 0u);
  EXPECT_EQ(complaint("# nothing\n"), "p: holds no pose");
  EXPECT_EQ(complaint("5,0,0,0,1,0,0\n").find("p:1: expected 't,px"), 0u);
  EXPECT_EQ(complaint("5.5,0,0,0,1,0,0,0\n").find("p:1: expected 't,px"), 0u);
  EXPECT_EQ(complaint("5,0,0,0,1,0,0,0\n4,0,0,0,1,0,0,0\n"), "p:2: times must increase from line to line");
  EXPECT_EQ(refusal_of([] { read_poses("/proc/nowhere"); }),
            "/proc/nowhere: cannot read this file: No such file or directory");
  EXPECT_EQ(refusal_of([] { read_poses("/dev/zero"); }),
            "/dev/zero: cannot read this file, this is a device");
  EXPECT_EQ(refusal_of([] { read_poses("/tmp"); }), "/tmp: cannot read this file, this is a folder");
}

}  // namespace
}  // namespace understory
