#pragma once

namespace understory {

class Flight;

/// Somebody who watches a flight: a record, a film, a data set, a page. What is told is what the flight can
/// be asked at that moment; no observer changes a flight.
class FlightObserver {
 public:
  virtual ~FlightObserver() = default;

  /// Whether images are rendered for it even where no detector looks at them. Asked once, before the flight.
  virtual bool needs_images() const { return false; }
  /// The stage of result.json that its wall time is booked under: a literal.
  virtual const char* stage() const { return "record"; }

  /// A frame has reached the autopilot, which has made its hits and its map of it: flight.frame().
  virtual void on_frame(const Flight&) {}
  /// Everything of this physics step is done but the physics.
  virtual void on_step(const Flight&) {}
};

}  // namespace understory
