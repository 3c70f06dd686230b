#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "perception/stereo_hit.hpp"
#include "perception/stereo_rig.hpp"
#include "scenarios/detect/posed_map.hpp"
#include "scenarios/report/picture_folder.hpp"
#include "scenarios/report/video_writer.hpp"

namespace understory {

/// What a person looks at after a detection run: the overlay of every frame, as overlays/000000.png ... or as
/// overlay.mp4.
class DetectionPictures {
 public:
  /// `film_rate_hz`: pictures a second of the film; 0 for single pictures.
  /// `looked_at`: the depths, for the caption: "10.14 m".
  DetectionPictures(const std::filesystem::path& folder, const StereoRig& rig, std::string looked_at,
                    double film_rate_hz);

  /// `left`: rectified. `map`, where there is one that covers the frame: its points go in as red dots.
  void add(const cv::Mat& left, const std::vector<StereoHit>& hits, const PosedMap* map);
  void finish();

 private:
  StereoRig rig_;
  std::string looked_at_;
  int scale_;
  std::unique_ptr<PictureFolder> pictures_;
  std::unique_ptr<VideoFile> film_;
  int count_ = 0;
};

}  // namespace understory
