#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace understory {

/// EuRoC's layout (EurocRecording), or stereo pairs with disparities as KITTI or Middlebury have them
/// (PairRecording).
enum class RecordingForm { euroc, kitti, middlebury };
inline constexpr std::array<std::pair<std::string_view, std::optional<RecordingForm>>, 3> recording_forms{
    {{"euroc", RecordingForm::euroc},
     {"kitti", RecordingForm::kitti},
     {"middlebury", RecordingForm::middlebury}}};

constexpr std::string_view word_for(RecordingForm form) {
  return recording_forms[static_cast<std::size_t>(form)].first;
}

struct RecordingChoice {
  std::optional<RecordingForm> form = {};  ///< nothing: no recording
  int every = 1;                           ///< every n-th stereo pair
  bool operator==(const RecordingChoice&) const = default;
};

}  // namespace understory
