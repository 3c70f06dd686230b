#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace understory {

/// Pictures numbered 000000.png, 000001.png ... in a folder that bears its name only when all of them are
/// there ("<folder>.part" until then).
class PictureFolder {
 public:
  explicit PictureFolder(std::filesystem::path folder);
  ~PictureFolder();  ///< removes what finish() has not made whole
  PictureFolder(const PictureFolder&) = delete;
  PictureFolder& operator=(const PictureFolder&) = delete;

  /// BGR or gray, 8-bit. Throws MachineError where the disk is full.
  void add(const cv::Mat& picture);
  void finish();

 private:
  std::filesystem::path folder_, part_;
  std::int64_t count_ = 0;
};

/// Removes a folder that such pictures made. Throws ScenarioError, removing nothing, where it holds anything
/// else.
void remove_pictures(const std::filesystem::path& folder);

}  // namespace understory
