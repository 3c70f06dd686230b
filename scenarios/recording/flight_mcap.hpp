#pragma once

#include <filesystem>
#include <memory>

#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_log.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {

/// A flight as an MCAP file with Foxglove's protobuf schemas, in simulated time, as docs/viewers.md lists its
/// topics: images, calibrations, clouds of hits, map and obstacles, transforms, plan, poses, numbers, log.
/// All but the images comes from the flight's log.
class FlightMcap : public FlightObserver {
 public:
  /// `log`: of the flight, kept by an observer that is called earlier. Images are JPEG, at most 60 pairs a
  /// second, which looks the same; `exact_images`: every one, as PNG. Throws ScenarioError where the file
  /// cannot be made.
  FlightMcap(const FlightLog& log, const std::filesystem::path& file, bool exact_images,
             FolderMark* mark = nullptr);
  ~FlightMcap() override;

  bool needs_images() const override { return true; }
  const char* stage() const override { return "mcap"; }
  void on_frame(const Flight& flight) override;
  void on_step(const Flight& flight) override;
  void on_end(const Flight& flight) override;

  /// Writes all of a log that is complete and has no images, and closes the file.
  void write_whole_log();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace understory
