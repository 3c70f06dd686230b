// The detector against a second writing of its rules from OpenCV's functions, block by block, on images of
// all kinds.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <optional>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/synthetic_stereo.hpp"

namespace understory {
namespace {

struct Reference {
  cv::Mat left, right, left_edges, right_edges;
  int disparity, infinity;

  Reference(const StereoFrame& frame, int disparity_px, int infinity_px)
      : left(frame.left), right(frame.right), disparity(disparity_px), infinity(infinity_px) {
    cv::Laplacian(left, left_edges, CV_8U, 3);
    cv::Laplacian(right, right_edges, CV_8U, 3);
  }

  static cv::Rect block(int u, int v) { return {u, v, 5, 5}; }
  static int sum(const cv::Mat& image, int u, int v) {
    return static_cast<int>(cv::sum(image(block(u, v)))[0]);
  }
  int sad(int u, int v, int right_u, int right_v) const {
    cv::Mat difference;
    cv::absdiff(left(block(u, v)), right(block(right_u, right_v)), difference);
    return static_cast<int>(cv::sum(difference)[0]);
  }

  bool scores(int u, int v, int minimum_edges, int per_mille_of_333) const {
    const int a = sum(left_edges, u, v), b = sum(right_edges, u - disparity, v);
    return a >= minimum_edges && b >= minimum_edges &&
           333000 * static_cast<long>(sad(u, v, u - disparity, v)) <
               static_cast<long>(per_mille_of_333) * (a + b);
  }

  bool repeats(int u, int v) const {
    for (int dv = -8; dv <= 8; dv += 2)
      for (int du = -3; du <= 3; ++du) {
        const int right_u = u - infinity + du, right_v = v + dv;
        if (u - infinity - 3 < 0 || u - infinity + 3 + 5 > right.cols) return true;
        if (v - 8 < 0 || v + 8 + 5 > right.rows) return true;
        const int a = sum(left_edges, u, v), b = sum(right_edges, right_u, right_v);
        if (b >= 860 && 333 * sad(u, v, right_u, right_v) < 108 * (a + b)) return true;
      }
    return false;
  }

  bool unique(int u, int v, int maximum) const {
    const int best = sad(u, v, u - disparity, v);
    for (int d = infinity; d <= maximum; ++d) {
      if (d == disparity || u - d < 0 || u - d + 5 > right.cols) continue;
      const int other = sad(u, v, u - d, v);
      if (std::abs(d - disparity) == 1 ? other < best : other <= 2 * best) return false;
    }
    return true;
  }
};

using Places = std::vector<std::pair<int, int>>;

Places places(const std::vector<StereoHit>& hits) {
  Places list;
  for (const StereoHit& hit : hits) list.emplace_back(hit.row_px, hit.column_px);
  return list;
}

/// Random, saturated, flat, textured; the right image partly the left one moved, so that every branch is
/// taken.
std::vector<StereoFrame> frames(const StereoRig& rig, int disparity, int infinity) {
  std::vector<StereoFrame> list;
  std::uint64_t seed = 4;
  for (const bool saturated : {false, true}) {
    for (const int shift : {disparity, infinity + 2}) {
      StereoFrame frame{0, support::noise(rig.width_px, rig.height_px, seed++, saturated),
                        support::noise(rig.width_px, rig.height_px, seed++, saturated)};
      const int half = rig.height_px / 2, wide = rig.width_px - shift;
      frame.left(cv::Rect(shift, 0, wide, half)).copyTo(frame.right(cv::Rect(0, 0, wide, half)));
      list.push_back(frame);
    }
  }
  list.push_back({0, cv::Mat(rig.height_px, rig.width_px, CV_8UC1, cv::Scalar(90)),
                  cv::Mat(rig.height_px, rig.width_px, CV_8UC1, cv::Scalar(90))});
  for (const double repeats_every_px : {0.0, 12.0, 13.0}) {
    support::SyntheticPlane plane{.depth_m = rig.depth_m(disparity + 0.3),
                                  .repeats_every_px = repeats_every_px};
    list.push_back(support::render_plane(rig, plane));
  }
  return list;
}

/// What the original's files state: a calibration, and by hand (or here from the calibration) two
/// disparities.
struct Case {
  const char* rig_file;
  std::optional<int> disparity_px, infinity_px;
};

void PrintTo(const Case& test, std::ostream* out) {
  *out << test.rig_file << (test.disparity_px ? " by hand" : "");
}

class ExactRule : public testing::TestWithParam<Case> {
 protected:
  StereoRig rig = support::house_rig(GetParam().rig_file);
  // u_left - u_right; the files state u_right - u_left.
  int disparity = -GetParam().disparity_px.value_or(
      -static_cast<int>(std::lround(rig.disparity_px(rig.detection_depth_m))));
  int infinity = -GetParam().infinity_px.value_or(
      static_cast<int>(std::lround(rig.center_right_x_px - rig.center_left_x_px)));

  PushbroomConfig stated(PushbroomConfig config) const {
    if (GetParam().disparity_px) config.disparities_px = {*GetParam().disparity_px};
    config.infinity_px = GetParam().infinity_px;
    return config;
  }
};

TEST_P(ExactRule, PaperRuleEqualsTheReference) {
  PushbroomStereo detector(rig, stated(original_pushbroom()));
  std::size_t found = 0, rejected = 0;
  for (const StereoFrame& frame : frames(rig, disparity, infinity)) {
    const Reference reference(frame, disparity, infinity);
    Places expected;
    // The original's loops ([2], docs/sources.md): blocks wholly above lastValidPixelRow, columns j < cols
    // - 5.
    for (int v = 0; v + 5 <= 205; v += 5)
      for (int u = reference.disparity; u < rig.width_px - 5; u += 5) {
        if (!reference.scores(u, v, 860, 54000)) continue;
        if (reference.repeats(u, v))
          ++rejected;
        else
          expected.emplace_back(v, u);
      }
    EXPECT_EQ(places(detector.detect(frame)), expected);
    found += expected.size();
  }
  EXPECT_GT(found, 300u);  // the comparison was about something
  EXPECT_GT(rejected, 100u);
}

TEST_P(ExactRule, UniquenessEqualsTheReference) {
  PushbroomConfig config = stated(robust_pushbroom());
  config.isolation = false;
  PushbroomStereo detector(rig, config);
  const int maximum = static_cast<int>(std::floor(rig.disparity_px(config.uniqueness_minimum_depth_m)));
  std::size_t found = 0, rejected = 0;
  for (const StereoFrame& frame : frames(rig, disparity, infinity)) {
    const Reference reference(frame, disparity, infinity);
    Places expected;
    for (int v = 0; v <= 205; v += 5)
      for (int u = reference.disparity; u + 5 <= rig.width_px; u += 5) {
        if (!reference.scores(u, v, 215, 83250)) continue;
        if (reference.unique(u, v, maximum))
          expected.emplace_back(v, u);
        else
          ++rejected;
      }
    EXPECT_EQ(places(detector.detect(frame)), expected);
    found += expected.size();
  }
  EXPECT_GT(found, 300u);
  EXPECT_GT(rejected, 100u);
}

// The original's files say 95 and 21 px where the calibrations' infinity lies at 92 and 20. A disparity of
// 106 leaves the left image columns for whole blocks only, of which the original leaves out the last.
INSTANTIATE_TEST_SUITE_P(Rigs, ExactRule,
                         testing::Values(Case{"paper.yaml", {}, {}}, Case{"long.yaml", {}, {}},
                                         Case{"paper.yaml", -105, -95}, Case{"paper.yaml", -106, -95},
                                         Case{"long.yaml", -31, -21}));

}  // namespace
}  // namespace understory
